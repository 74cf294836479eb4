#include "cad/model/scaled_model.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_bytes.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/patches.hpp"

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

namespace aeroloom::cad {
namespace {

constexpr std::uint64_t magic_of_scaled = 0x534d4c4145524f41;  // "AOREALMS"

PrincipalCurvatures scaled_curvatures(PrincipalCurvatures curvatures, double unit) {
  curvatures.largest /= unit, curvatures.smallest /= unit;
  return curvatures;
}

}  // namespace

Box scaled(const Box& box, double factor) {
  if (box.empty()) return box;
  return {factor * box.low, factor * box.high};
}

FacePlace scaled(const FacePlace& place, double factor) {
  return {factor * factor * place.area, factor * place.centre, scaled(place.box, factor)};
}

SurfaceFrame ScaledModel::face_frame(FaceId id, Vec2 uv) const {
  const SurfaceFrame frame = model.face_frame(id, uv);
  return {unit * frame.point, unit * frame.du, unit * frame.dv, frame.normal};
}

PrincipalCurvatures ScaledModel::face_curvatures(FaceId id, Vec2 uv) const {
  return scaled_curvatures(model.face_curvatures(id, uv), unit);
}

CurvedPoint ScaledModel::face_curved_point(FaceId id, Vec2 uv) const {
  const CurvedPoint found = model.face_curved_point(id, uv);
  return {unit * found.point, scaled_curvatures(found.curvatures, unit)};
}

Projection ScaledModel::project(FaceId id, Vec3 point, Vec2 guess) const {
  Projection found = model.project(id, point / unit, guess);
  found.point = unit * found.point;
  return found;
}

double ScaledModel::face_area(FaceId id) const {
  const InLibraryUnit at_hand(unit);
  return unit * unit * model.face_area(id);
}

Vec3 ScaledModel::face_area_vector(FaceId id) const {
  const InLibraryUnit at_hand(unit);
  return unit * unit * model.face_area_vector(id);
}

double ScaledModel::region_volume(RegionId id) const {
  const InLibraryUnit at_hand(unit);
  return unit * unit * unit * model.region_volume(id);
}

FacePlace ScaledModel::face_place(FaceId id) const {
  const InLibraryUnit at_hand(unit);
  return scaled(model.face_place(id), unit);
}

Facets ScaledModel::facets(FaceId id, double deflection, double angle, Model::Keep keep) const {
  const InLibraryUnit at_hand(unit);
  Facets facets = model.facets(id, deflection / unit, angle, keep);
  for (Vec3& point : facets.points) point = unit * point;
  return facets;
}

Model in_file_unit(Model model, double unit) {
  if (unit == 1) return model;
  const Model::Data& from = model.data();
  auto data = std::make_shared<Model::Data>();
  ByteWriter writer;
  writer.put(magic_of_scaled);
  writer.put(unit);
  writer.bytes.insert(writer.bytes.end(), from.bytes.begin(), from.bytes.end());
  data->bytes = std::move(writer.bytes);
  data->vertices.reserve(static_cast<std::size_t>(model.vertex_count()));
  for (VertexId v = 0; v < model.vertex_count(); ++v) data->vertices.push_back(unit * model.vertex(v));
  data->vertex_snaps.resize(data->vertices.size());
  data->edges = from.edges, data->faces = from.faces, data->far_field = from.far_field;
  data->region_names = from.region_names, data->patches = from.patches;
  data->bounds = scaled(from.bounds, unit), data->body_bounds = scaled(from.body_bounds, unit);
  data->unit_name = from.unit_name, data->unit_in_metres = from.unit_in_metres;
  data->gap = unit * from.gap;
  data->scaled = std::make_shared<const ScaledModel>(ScaledModel{std::move(model), unit});
  return Model(std::move(data));
}

Model within(const Model& scaled) {
  std::vector<std::string> patches;
  patches.reserve(static_cast<std::size_t>(scaled.face_count()));
  for (FaceId f = 0; f < scaled.face_count(); ++f)
    patches.push_back(scaled.patches()[static_cast<std::size_t>(scaled.face(f).patch)]);
  return with_patches(scaled.data().scaled->model, patches);
}

bool are_of_scaled_model(std::span<const std::byte> bytes) {
  std::uint64_t first = 0;
  if (bytes.size() < sizeof(first)) return false;
  std::memcpy(&first, bytes.data(), sizeof(first));
  return first == magic_of_scaled;
}

Model scaled_from_bytes(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  reader.get<std::uint64_t>();
  const auto unit = reader.get<double>();
  if (!std::isfinite(unit) || unit <= 0) throw CadError("these bytes are no model of this version");
  return in_file_unit(Model::from_bytes(bytes.subspan(sizeof(std::uint64_t) + sizeof(double))), unit);
}

}  // namespace aeroloom::cad
