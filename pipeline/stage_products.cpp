#include "pipeline/stage_products.hpp"

#include "cad/model/joined_faces.hpp"
#include "pipeline/domain_bytes.hpp"

#include <utility>

namespace aeroloom::pipeline {
namespace {

using io::CheckpointContent;
using io::CheckpointDraft;
using parallel::Packer;
using parallel::Unpacker;

template <class T>
void pack_optional(const std::optional<T>& value, Packer& packer) {
  packer.value(std::uint8_t{value.has_value()});
  if (value) packer.value(*value);
}

template <class T>
std::optional<T> unpack_optional(Unpacker& unpacker) {
  if (unpacker.value<std::uint8_t>() == 0) return std::nullopt;
  return unpacker.value<T>();
}

void pack_texts(const std::vector<std::string>& texts, Packer& packer) {
  packer.value(static_cast<std::uint64_t>(texts.size()));
  for (const std::string& text : texts) packer.text(text);
}

std::vector<std::string> unpack_texts(Unpacker& unpacker) {
  std::vector<std::string> texts;
  const auto count = unpacker.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) texts.push_back(unpacker.text());
  return texts;
}

/// Everything but the pieces, which become items.
void pack_mesh(const mesh::DistributedMesh& mesh, Packer& packer, CheckpointDraft& draft) {
  packer.value(mesh.kind);
  packer.value(mesh.piece_count);
  packer.value(mesh.cavity_rounds);
  pack_texts(mesh.patches, packer);
  packer.array(mesh.patch_types);
  pack_texts(mesh.faces, packer);
  packer.array(mesh.sides);
  pack_texts(mesh.regions, packer);
  for (const mesh::Piece& piece : mesh.pieces)
    draft.items.push_back({piece.id, [&piece] { return parallel::to_wire(piece); }});
}

/// Items go as their pieces come.
mesh::DistributedMesh unpack_mesh(Unpacker& unpacker, std::vector<CheckpointContent::Item> items) {
  mesh::DistributedMesh mesh;
  mesh.kind = unpacker.value<mesh::CellKind>();
  mesh.piece_count = unpacker.value<mesh::PieceId>();
  mesh.cavity_rounds = unpacker.value<std::int32_t>();
  mesh.patches = unpack_texts(unpacker);
  mesh.patch_types = unpacker.array<mesh::PatchType>();
  mesh.faces = unpack_texts(unpacker);
  mesh.sides = unpacker.array<mesh::FaceSides>();
  mesh.regions = unpack_texts(unpacker);
  for (CheckpointContent::Item& item : items)
    mesh.pieces.push_back(parallel::from_wire<mesh::Piece>(std::exchange(item.bytes, parallel::Bytes())));
  return mesh;
}

void pack_features(const FeatureReport& features, Packer& packer) {
  packer.value(features.share);
  packer.value(features.tetrahedra);
  packer.value(static_cast<std::uint64_t>(features.strips.size()));
  for (const UnresolvedStrip& strip : features.strips) {
    packer.text(strip.face);
    packer.value(strip.width);
    packer.value(strip.place);
    packer.value(strip.surface_degrees);
  }
}

FeatureReport unpack_features(Unpacker& unpacker) {
  FeatureReport features;
  features.share = unpacker.value<sizing::FeatureShare>();
  features.tetrahedra = unpacker.value<double>();
  features.strips.resize(unpacker.value<std::uint64_t>());
  for (UnresolvedStrip& strip : features.strips) {
    strip.face = unpacker.text();
    strip.width = unpacker.value<double>();
    strip.place = unpacker.value<geometry::Vec3>();
    strip.surface_degrees = unpacker.value<double>();
  }
  return features;
}

/// What a surface depends on.
parallel::Digest digest_of(const SizedDomain& sized) {
  const parallel::Digest field = sized.field.digest();
  parallel::Digester digester;
  digester.value(field.low).value(field.high);
  for (const std::vector<cad::FaceId>& group : sized.joined.groups)
    digester.items(std::span<const cad::FaceId>(group));
  return digester.result();
}

void pack_report(const surface::SurfaceReport& report, Packer& packer) {
  packer.value(report.curve_vertices);
  packer.value(report.pieces);
  packer.value(report.divided_faces);
  packer.array(report.cut_angles);
  packer.array(report.sharp_corners);
  packer.array(report.closed_tips);
  packer.array(report.needles);
  packer.value(report.triangles);
  packer.value(report.mending_rounds);
  packer.value(report.load_error_90);
}

surface::SurfaceReport unpack_surface_report(Unpacker& unpacker) {
  surface::SurfaceReport report;
  report.curve_vertices = unpacker.value<std::int64_t>();
  report.pieces = unpacker.value<std::int64_t>();
  report.divided_faces = unpacker.value<std::int64_t>();
  report.cut_angles = unpacker.array<surface::CutAngle>();
  report.sharp_corners = unpacker.array<surface::ListedCorner>();
  report.closed_tips = unpacker.array<surface::ClosedTip>();
  report.needles = unpacker.array<surface::NeedleGroup>();
  report.triangles = unpacker.value<std::int64_t>();
  report.mending_rounds = unpacker.value<int>();
  report.load_error_90 = unpacker.value<double>();
  return report;
}

void pack_report(const volume::VolumeReport& report, Packer& packer) {
  packer.value(report.tetrahedra);
  packer.value(report.overlap);
  packer.value(report.steiner_points);
  packer.value(static_cast<std::uint64_t>(report.retries.size()));
  for (const volume::Retry& retry : report.retries) {
    packer.value(retry.zone);
    packer.text(retry.change);
    packer.text(retry.reason);
  }
  packer.array(report.disagreements);
  packer.value(report.rounds);
  packer.value(report.load_error_90);
}

volume::VolumeReport unpack_volume_report(Unpacker& unpacker) {
  volume::VolumeReport report;
  report.tetrahedra = unpacker.value<std::int64_t>();
  report.overlap = unpacker.value<double>();
  report.steiner_points = unpacker.value<std::int64_t>();
  report.retries.resize(unpacker.value<std::uint64_t>());
  for (volume::Retry& retry : report.retries) {
    retry.zone = unpacker.value<std::int32_t>();
    retry.change = unpacker.text();
    retry.reason = unpacker.text();
  }
  report.disagreements = unpacker.array<volume::Disagreement>();
  report.rounds = unpacker.value<int>();
  report.load_error_90 = unpacker.value<double>();
  return report;
}

}  // namespace

CheckpointDraft pack_domain_product(const cad::Domain& domain) {
  Packer packer;
  pack_domain(domain, packer);
  return {packer.take(), {}};
}

cad::Domain unpack_domain_product(CheckpointContent content) {
  Unpacker unpacker(content.common);
  return unpack_domain(unpacker);
}

CheckpointDraft pack_sizes(const SizedDomain& sized) {
  Packer packer;
  packer.value(sized.sizes);
  packer.array(sized.field.pack());
  packer.value(static_cast<std::uint64_t>(sized.joined.groups.size()));
  for (const std::vector<cad::FaceId>& group : sized.joined.groups) packer.array(group);
  pack_changes(sized.joined.changes, packer);
  pack_optional(sized.counts, packer);
  packer.value(std::uint8_t{sized.features.has_value()});
  if (sized.features) pack_features(*sized.features, packer);
  return {packer.take(), {}};
}

SizedDomain unpack_sizes(const parallel::Communicator& communicator, CheckpointContent content,
                         const cad::Model& domain) {
  Unpacker unpacker(content.common);
  const auto sizes = unpacker.value<sizing::SizingOptions>();
  sizing::SizeField field = sizing::SizeField::unpack(communicator, unpacker.array<std::byte>());
  SizedDomain sized{domain, sizes, std::move(field), {}, {}, {}};
  sized.joined.groups.resize(unpacker.value<std::uint64_t>());
  for (std::vector<cad::FaceId>& group : sized.joined.groups) group = unpacker.array<cad::FaceId>();
  if (!sized.joined.groups.empty()) sized.model = cad::join_faces(domain, sized.joined.groups);
  sized.joined.changes = unpack_changes(unpacker);
  sized.counts = unpack_optional<sizing::PredictedCounts>(unpacker);
  if (unpacker.value<std::uint8_t>() != 0) sized.features = unpack_features(unpacker);
  return sized;
}

// The common part of rank 0 counts: others pack none of what each node holds once.
CheckpointDraft pack_surface(const parallel::Communicator& communicator, const SurfaceProduct& product) {
  CheckpointDraft draft;
  Packer packer;
  packer.value(digest_of(product.sized));
  const bool root = communicator.is_root();
  packer.array(root && product.sizes_are_other ? pack_sizes(product.sized).common : parallel::Bytes());
  pack_report(product.report, packer);
  const bool refined = product.field.digest() != product.sized.field.digest();
  packer.array(root && refined ? product.field.pack() : parallel::Bytes());
  pack_mesh(product.mesh, packer, draft);
  draft.common = packer.take();
  return draft;
}

std::optional<surface::SurfaceMesh> unpack_surface(const parallel::Communicator& communicator,
                                                   CheckpointContent content, const cad::Model& domain,
                                                   SizedDomain& sized) {
  Unpacker unpacker(content.common);
  const auto wanted = unpacker.value<parallel::Digest>();
  if (parallel::Bytes sizes = unpacker.array<std::byte>(); !sizes.empty())
    sized = unpack_sizes(communicator, {std::move(sizes), {}}, domain);
  if (wanted != digest_of(sized)) return std::nullopt;
  surface::SurfaceReport report = unpack_surface_report(unpacker);
  const parallel::Bytes refined = unpacker.array<std::byte>();
  mesh::DistributedMesh mesh = unpack_mesh(unpacker, std::move(content.items));
  return surface::SurfaceMesh{
      std::move(mesh), std::move(report),
      refined.empty() ? sized.field : sizing::SizeField::unpack(communicator, refined)};
}

CheckpointDraft pack_volume(const mesh::DistributedMesh& mesh,
                            const volume::DecompositionReport& decomposition,
                            const volume::VolumeReport& volume, const improve::ImproveReport& improve) {
  CheckpointDraft draft;
  Packer packer;
  packer.value(decomposition);
  pack_report(volume, packer);
  packer.value(improve);
  pack_mesh(mesh, packer, draft);
  draft.common = packer.take();
  return draft;
}

VolumeProduct unpack_volume(CheckpointContent content) {
  Unpacker unpacker(content.common);
  VolumeProduct product;
  product.decomposition = unpacker.value<volume::DecompositionReport>();
  product.volume = unpack_volume_report(unpacker);
  product.improve = unpacker.value<improve::ImproveReport>();
  product.mesh = unpack_mesh(unpacker, std::move(content.items));
  return product;
}

}  // namespace aeroloom::pipeline
