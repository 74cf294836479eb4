#include "cad/faceted/faceted_bytes.hpp"

#include "cad/model/model_data.hpp"

#include <algorithm>
#include <optional>
#include <ranges>
#include <utility>

namespace aeroloom::cad {
namespace {

FacetComplex get_complex(ByteReader& reader) {
  FacetComplex complex;
  complex.points = reader.get_all<Vec3>();
  complex.triangles = reader.get_all<std::array<std::int32_t, 3>>();
  complex.face_of = reader.get_all<FaceId>();
  complex.vertices = reader.get_all<std::int32_t>();
  for (auto left = reader.get<std::uint64_t>(); left > 0; --left)
    complex.curves.push_back({reader.get_all<std::int32_t>()});
  for (auto left = reader.get<std::uint64_t>(); left > 0; --left) {
    FacetComplex::Face& face = complex.faces.emplace_back();
    face.name = reader.get_text(), face.part = reader.get_text();
    face.front = reader.get<RegionId>(), face.back = reader.get<RegionId>();
    face.cavity = reader.get<char>() != 0;
  }
  complex.regions = reader.get_texts();
  return complex;
}

/// The axis along which all points of a face have one coordinate, bit for bit.
std::optional<int> exact_axis(const FacetedGeometry& faceted, const FacetedFace& face) {
  const Vec3 first = faceted.complex().points[face.points.front()];
  for (int axis = 0; axis < 3; ++axis) {
    const bool same = std::ranges::all_of(
        face.points, [&](std::int32_t p) { return faceted.complex().points[p][axis] == first[axis]; });
    if (same) return axis;
  }
  return std::nullopt;
}

}  // namespace

void put_faceted(const FacetedGeometry* faceted, ByteWriter& writer) {
  writer.put<char>(faceted != nullptr);
  if (!faceted) return;
  const FacetComplex& complex = faceted->complex();
  writer.put(faceted->planar_tolerance());
  writer.put_all(complex.points);
  writer.put_all(complex.triangles);
  writer.put_all(complex.face_of);
  writer.put_all(complex.vertices);
  writer.put<std::uint64_t>(complex.curves.size());
  for (const FacetComplex::Curve& curve : complex.curves) writer.put_all(curve.points);
  writer.put<std::uint64_t>(complex.faces.size());
  for (const FacetComplex::Face& face : complex.faces) {
    writer.put_text(face.name), writer.put_text(face.part);
    writer.put(face.front), writer.put(face.back);
    writer.put<char>(face.cavity);
  }
  writer.put_texts(complex.regions);
  writer.put_all(faceted->sheets().sheets);
  writer.put_all(faceted->sheets().of);
}

std::shared_ptr<const FacetedGeometry> get_faceted(ByteReader& reader) {
  if (reader.get<char>() == 0) return nullptr;
  const auto tolerance = reader.get<double>();
  FacetComplex complex = get_complex(reader);
  FacetSheets sheets;
  sheets.sheets = reader.get_all<FlatSheet>();
  sheets.of = reader.get_all<std::int32_t>();
  return std::make_shared<const FacetedGeometry>(std::move(complex), std::move(sheets), tolerance);
}

void number_facets(Model::Data& data) {
  const FacetedGeometry& faceted = *data.faceted;
  const FacetComplex& complex = faceted.complex();
  data.first_faceted_vertex = static_cast<VertexId>(data.vertices.size());
  data.first_faceted_edge = static_cast<EdgeId>(data.edges.size());
  data.first_faceted_face = static_cast<FaceId>(data.faces.size());
  for (const std::int32_t p : complex.vertices) data.vertices.push_back(complex.points[p]);
  data.vertex_snaps.resize(data.vertices.size());
  const auto vertex_at = [&](std::int32_t point) {
    const auto found = std::lower_bound(complex.vertices.begin(), complex.vertices.end(), point);
    return data.first_faceted_vertex + static_cast<VertexId>(found - complex.vertices.begin());
  };
  for (const FacetedEdge& own : faceted.edges()) {
    Edge& edge = data.edges.emplace_back();
    edge.first = vertex_at(own.points.front()), edge.last = vertex_at(own.points.back());
    edge.last_parameter = own.along.back();
    for (const FacetedUse& use : own.uses) edge.faces.push_back(data.first_faceted_face + use.face);
  }
  data.edge_snaps.resize(data.edges.size());
  for (std::size_t f = 0; f < faceted.faces().size(); ++f) {
    const FacetedFace& own = faceted.faces()[f];
    Face& face = data.faces.emplace_back();
    face.loops = own.loops;
    for (Coedge& use : face.loops | std::views::join) use.edge += data.first_faceted_edge;
    face.front = complex.faces[f].front, face.back = complex.faces[f].back;
    Snap& snap = data.face_snaps.emplace_back();
    if (const auto axis = exact_axis(faceted, own))
      snap.fix(*axis, complex.points[own.points.front()][*axis]);
  }
}

FaceIntegrals integrate_facets(const FacetedGeometry& faceted, FaceId id, Vec3 reference) {
  FaceIntegrals sums;
  const FacetedFace& face = faceted.faces()[id];
  for (std::int32_t t = face.first; t < face.first + face.count; ++t) {
    const auto corners = corners_of(faceted.complex(), t);
    const Vec3 vector = 0.5 * area_vector2(corners);
    const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3 - reference;
    const double area = norm(vector);
    sums.area += area;
    sums.flux += dot(centre, vector) / 3;
    sums.area_vector += vector;
    sums.moment += area * centre;
  }
  return sums;
}

}  // namespace aeroloom::cad
