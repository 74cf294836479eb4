#include "pipeline/stage_products.hpp"

#include "cad/model/topology/joined_faces.hpp"
#include "pipeline/domain/domain_bytes.hpp"

#include <tuple>
#include <utility>

namespace aeroloom::pipeline {
namespace {

using io::CheckpointContent;
using io::CheckpointDraft;
using parallel::Bytes;
using parallel::from_wire;
using parallel::to_wire;

std::vector<CheckpointDraft::Item> draft_pieces(const mesh::DistributedMesh& mesh) {
  std::vector<CheckpointDraft::Item> items;
  for (const mesh::Piece& piece : mesh.pieces)
    items.push_back({piece.id, [&piece] { return to_wire(piece); }});
  return items;
}

/// Items go as their pieces come.
mesh::DistributedMesh make_mesh(const parallel::Communicator& communicator, mesh::MeshFacts facts,
                                std::vector<CheckpointContent::Item> items) {
  mesh::DistributedMesh mesh(communicator, std::move(facts));
  for (CheckpointContent::Item& item : items)
    mesh.pieces.push_back(from_wire<mesh::Piece>(std::exchange(item.bytes, Bytes())));
  return mesh;
}

/// The part of the sizes that is kept for a run that resumes.
struct SizesRecord {
  sizing::SizingOptions sizes;
  Bytes field;
  domain::SizingFindings findings;

  static constexpr auto fields() {
    return std::tuple(&SizesRecord::sizes, &SizesRecord::field, &SizesRecord::findings);
  }
};

/// The part of a surface, besides its pieces, that is kept for a run that resumes.
struct SurfaceRecord {
  parallel::Digest sized;  ///< what it depends on
  Bytes sizes;             ///< where they are not those of the stage before
  surface::SurfaceReport report;
  Bytes field;  ///< where it is not that of the sizes
  mesh::MeshFacts mesh;

  static constexpr auto fields() {
    return std::tuple(&SurfaceRecord::sized, &SurfaceRecord::sizes, &SurfaceRecord::report,
                      &SurfaceRecord::field, &SurfaceRecord::mesh);
  }
};

/// The part of a volume, besides its pieces, that is kept for a run that resumes.
struct VolumeRecord {
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  improve::ImproveReport improve;
  mesh::MeshFacts mesh;

  static constexpr auto fields() {
    return std::tuple(&VolumeRecord::decomposition, &VolumeRecord::volume, &VolumeRecord::improve,
                      &VolumeRecord::mesh);
  }
};

/// The digest of everything that a surface depends on.
parallel::Digest digest_of(const domain::SizedDomain& sized) {
  const parallel::Digest field = sized.field.digest();
  parallel::Digester digester;
  digester.value(field.low).value(field.high);
  for (const std::vector<cad::FaceId>& group : sized.findings.joined.groups)
    digester.items(std::span<const cad::FaceId>(group));
  for (const domain::JudgedEdge& edge : sized.findings.edges)
    if (edge.fate == domain::EdgeFate::closed) digester.value(edge.face);
  return digester.result();
}

}  // namespace

CheckpointDraft pack_domain_product(const cad::Domain& domain) {
  return {domain::pack_domain(domain), {}};
}

cad::Domain unpack_domain_product(CheckpointContent content) {
  return domain::unpack_domain(content.common);
}

CheckpointDraft pack_sizes(const domain::SizedDomain& sized) {
  return {to_wire(SizesRecord{sized.sizes, sized.field.pack(), sized.findings}), {}};
}

domain::SizedDomain unpack_sizes(const parallel::Communicator& communicator, CheckpointContent content,
                                 const cad::Model& domain) {
  auto record = from_wire<SizesRecord>(content.common);
  cad::Model model = domain::close_again(domain, record.findings.edges);
  sizing::SizeField field = sizing::SizeField::unpack(communicator, record.field);
  const std::vector<std::vector<cad::FaceId>>& groups = record.findings.joined.groups;
  if (!groups.empty()) model = cad::join_faces(model, groups);
  return {std::move(model), record.sizes, std::move(field), std::move(record.findings)};
}

// The common part of rank 0 counts: others pack none of what each node holds once.
CheckpointDraft pack_surface(const parallel::Communicator& communicator, const SurfaceProduct& product) {
  SurfaceRecord record{digest_of(product.sized), {}, product.surface.report, {}, product.surface};
  if (communicator.is_root()) {
    if (product.sizes_are_other) record.sizes = pack_sizes(product.sized).common;
    const sizing::SizeField& field = product.surface.field;
    if (field.digest() != product.sized.field.digest()) record.field = field.pack();
  }
  return {to_wire(record), draft_pieces(product.surface)};
}

std::optional<surface::SurfaceMesh> unpack_surface(const parallel::Communicator& communicator,
                                                   CheckpointContent content, const cad::Model& domain,
                                                   domain::SizedDomain& sized) {
  auto record = from_wire<SurfaceRecord>(content.common);
  if (!record.sizes.empty()) sized = unpack_sizes(communicator, {std::move(record.sizes), {}}, domain);
  if (record.sized != digest_of(sized)) return std::nullopt;
  mesh::DistributedMesh mesh = make_mesh(communicator, std::move(record.mesh), std::move(content.items));
  return surface::SurfaceMesh{
      {mesh::number_mesh(std::move(mesh)),
       record.field.empty() ? sized.field : sizing::SizeField::unpack(communicator, record.field)},
      std::move(record.report)};
}

CheckpointDraft pack_volume(const VolumeProduct& product) {
  return {to_wire(VolumeRecord{product.decomposition, product.volume, product.improve, product.mesh}),
          draft_pieces(product.mesh)};
}

VolumeProduct unpack_volume(const parallel::Communicator& communicator, CheckpointContent content) {
  auto record = from_wire<VolumeRecord>(content.common);
  return {make_mesh(communicator, std::move(record.mesh), std::move(content.items)), record.decomposition,
          std::move(record.volume), record.improve};
}

}  // namespace aeroloom::pipeline
