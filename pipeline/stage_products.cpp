#include "pipeline/stage_products.hpp"

#include "cad/model/topology/joined_faces.hpp"

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

/// Frees the bytes of each item once its piece is made.
mesh::DistributedMesh add_pieces(mesh::DistributedMesh mesh, std::vector<CheckpointContent::Item> items) {
  for (CheckpointContent::Item& item : items)
    mesh.pieces.push_back(from_wire<mesh::Piece>(std::exchange(item.bytes, Bytes())));
  return mesh;
}

/// The part of the sizes that is kept for a run that resumes.
struct SizesRecord {
  sizing::SizingOptions sizes;
  Bytes field;
  domain::SizingFindings findings;
};

/// The part of a surface, besides its pieces, that is kept for a run that resumes.
struct SurfaceRecord {
  parallel::Digest sized;  ///< what it depends on
  Bytes sizes;             ///< where they are not those of the stage before
  surface::SurfaceReport report;
  Bytes field;  ///< where it is not that of the sizes
  mesh::MeshFacts mesh;
};

/// The part of a volume, besides its pieces, that is kept for a run that resumes.
struct VolumeRecord {
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  improve::ImproveReport improve;
  mesh::MeshFacts mesh;
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
CheckpointDraft pack_surface(const SurfaceProduct& product) {
  SurfaceRecord record{digest_of(product.sized), {}, product.surface.report, {}, product.surface};
  if (product.surface.communicator.is_root()) {
    if (product.sizes_are_other) record.sizes = pack_sizes(product.sized).common;
    const sizing::SizeField& field = product.surface.field;
    if (field.digest() != product.sized.field.digest()) record.field = field.pack();
  }
  return {to_wire(record), draft_pieces(product.surface)};
}

std::optional<surface::SurfaceMesh> unpack_surface(CheckpointContent content, const cad::Model& domain,
                                                   domain::SizedDomain& sized) {
  const parallel::Communicator communicator = sized.field.communicator();
  auto record = from_wire<SurfaceRecord>(content.common);
  if (!record.sizes.empty()) sized = unpack_sizes(communicator, {std::move(record.sizes), {}}, domain);
  if (record.sized != digest_of(sized)) return std::nullopt;
  mesh::DistributedMesh mesh =
      add_pieces(mesh::DistributedMesh(communicator, std::move(record.mesh)), std::move(content.items));
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
  return {add_pieces(mesh::DistributedMesh(communicator, std::move(record.mesh)), std::move(content.items)),
          record.decomposition, std::move(record.volume), record.improve};
}

}  // namespace aeroloom::pipeline
