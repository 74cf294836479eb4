#include "cad/faceted/faceted_bytes.hpp"
#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/evaluation/face_cache.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/model/topology/closed_edges_data.hpp"
#include "cad/model/topology/sheets.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <TColStd_Array1OfReal.hxx>

namespace aeroloom::cad {
namespace {

/// Parameters for a point that was moved away from those of `guess`: where the surface goes on to it, its
/// own, else the guess, which lies on the face's border.
Vec2 follow_moved_point(const FaceEvaluator& face, Vec3 point, Vec2 guess, double tolerance) {
  const Vec2 found = find_parameters(face, point, guess, tolerance);
  const double before = distance(face.surface.point(guess), point);
  return distance(face.surface.point(found), point) < 0.5 * before ? found : guess;
}

PrincipalCurvatures curvatures_of(const SurfaceJet& jet) {
  const double e = dot(jet.du, jet.du), f = dot(jet.du, jet.dv), g = dot(jet.dv, jet.dv);
  const Vec3 normal = cross(jet.du, jet.dv);
  const double area = norm(normal);
  if (!(area > tolerances::rounding * std::max(e, g))) return {};
  const double l = dot(jet.duu, normal) / area, m = dot(jet.duv, normal) / area,
               n = dot(jet.dvv, normal) / area;
  const double determinant = area * area;
  const double mean = 0.5 * (e * n - 2 * f * m + g * l) / determinant;
  const double gauss = (l * n - m * m) / determinant;
  const double spread = std::sqrt(std::max(0.0, mean * mean - gauss));
  const double first = std::abs(mean + spread), second = std::abs(mean - spread);
  if (!std::isfinite(first) || !std::isfinite(second)) return {};
  return {std::max(first, second), std::min(first, second), true};
}

}  // namespace

std::int32_t Model::vertex_count() const {
  return static_cast<std::int32_t>(_data->vertices.size());
}
std::int32_t Model::edge_count() const {
  return static_cast<std::int32_t>(_data->edges.size());
}
std::int32_t Model::face_count() const {
  return static_cast<std::int32_t>(_data->faces.size());
}
std::int32_t Model::region_count() const {
  return static_cast<std::int32_t>(_data->region_names.size());
}
Vec3 Model::vertex(VertexId id) const {
  return _data->vertex_snaps.at(id)(_data->vertices[id]);
}
const Edge& Model::edge(EdgeId id) const {
  return _data->edges.at(id);
}
const Face& Model::face(FaceId id) const {
  return _data->faces.at(id);
}
const std::string& Model::region_name(RegionId id) const {
  return _data->region_names.at(id);
}
const std::vector<std::string>& Model::patches() const {
  return _data->patches;
}
const Box& Model::bounds() const {
  return _data->bounds;
}
const Box& Model::body_bounds() const {
  return _data->body_bounds;
}
bool Model::is_far_field(FaceId id) const {
  return _data->far_field.at(id) != 0;
}
const std::string& Model::unit_name() const {
  return _data->unit_name;
}
double Model::unit_in_metres() const {
  return _data->unit_in_metres;
}
double Model::sewn_gap() const {
  return _data->gap;
}
std::vector<std::byte> Model::serialise() const {
  return _data->bytes;
}

Vec3 Model::edge_point(EdgeId id, double parameter) const {
  if (_data->scaled) return _data->scaled->edge_point(id, parameter);
  const Edge& edge = _data->edges.at(id);
  if (edge.degenerate) return vertex(edge.first);
  if (const FacetedGeometry* faceted = _data->faceted_edge(id))
    return faceted->edge_point(id - _data->first_faceted_edge, parameter);
  return _data->edge_snaps[id](to_vec(_data->edge_evaluators[id].curve.Value(parameter)));
}

Vec3 Model::edge_tangent(EdgeId id, double parameter) const {
  if (_data->scaled) return _data->scaled->edge_tangent(id, parameter);
  if (_data->edges.at(id).degenerate) return {};
  if (const FacetedGeometry* faceted = _data->faceted_edge(id))
    return faceted->edge_tangent(id - _data->first_faceted_edge, parameter);
  gp_Pnt point;
  gp_Vec tangent;
  _data->edge_evaluators[id].curve.D1(parameter, point, tangent);
  return to_vec(tangent);
}

double Model::edge_curvature(EdgeId id, double parameter) const {
  if (_data->scaled) return _data->scaled->edge_curvature(id, parameter);
  if (const FacetedGeometry* faceted = _data->faceted_edge(id))
    return faceted->edge_curvature(id - _data->first_faceted_edge, parameter);
  const EdgeEvaluator& evaluator = _data->edge_evaluators.at(id);
  if (_data->edges[id].degenerate || evaluator.curve.GetType() == GeomAbs_Line) return 0;
  gp_Pnt point;
  gp_Vec first, second;
  evaluator.curve.D2(parameter, point, first, second);
  const double speed = first.Magnitude();
  const double curvature = first.Crossed(second).Magnitude() / (speed * speed * speed);
  return std::isfinite(curvature) ? curvature : 0;
}

// Curve and parameter curve of an edge trace the same line, in many files not at the same pace: the parameter
// curve gives a guess, the point of the edge decides.
Vec2 Model::edge_uv(FaceId face, const Coedge& use, double parameter) const {
  if (_data->scaled) return _data->scaled->model.edge_uv(face, use, parameter);
  if (const JoinedModel* joined = _data->joined.get()) {
    const JoinedFace& all = joined->faces.at(face);
    if (all.sheets.size() == 1) return joined->base.edge_uv(all.sheets.front().face, use, parameter);
    const JoinedFace::Use& own = all.use(use);
    return all.from_member(own.sheet, joined->base.edge_uv(all.sheets[own.sheet].face, own.base, parameter));
  }
  if (const FacetedGeometry* faceted = _data->faceted_face(face))
    return faceted->edge_uv(use.edge - _data->first_faceted_edge, face - _data->first_faceted_face,
                            parameter);
  const FaceEvaluator& evaluator = _data->face_evaluators.at(face);
  if (const ClosedEdges* closed = _data->closed.get()) {
    const Vec2 guess = closed->base_uv(face, use, parameter);
    if (!closed->moved[use.edge] || _data->edges[use.edge].degenerate) return guess;
    return follow_moved_point(evaluator, edge_point(use.edge, parameter), guess,
                              tolerances::foot_beside * _data->bounds.diagonal());
  }
  const UseCurve& on_face = evaluator.use(use);
  const Edge& edge = _data->edges[use.edge];
  double at = parameter;
  if (on_face.first != edge.first_parameter || on_face.last != edge.last_parameter) {
    const double fraction = (parameter - edge.first_parameter) / (edge.last_parameter - edge.first_parameter);
    at = on_face.first + fraction * (on_face.last - on_face.first);
  }
  const gp_Pnt2d guess = on_face.curve.Value(at);
  const bool is_end = parameter == edge.first_parameter || parameter == edge.last_parameter;
  if (edge.degenerate || is_end) return {guess.X(), guess.Y()};
  return find_parameters(evaluator, edge_point(use.edge, parameter), {guess.X(), guess.Y()},
                         tolerances::foot_beside * _data->bounds.diagonal());
}

std::vector<double> Model::edge_breaks(EdgeId id) const {
  if (_data->scaled) return _data->scaled->model.edge_breaks(id);
  const Edge& edge = _data->edges.at(id);
  if (edge.degenerate || _data->faceted_edge(id)) return {edge.first_parameter, edge.last_parameter};
  return guarded("splitting an edge where it is not smooth", [&] {
    const GeomAdaptor_Curve& curve = _data->edge_evaluators[id].curve;
    TColStd_Array1OfReal breaks(1, curve.NbIntervals(GeomAbs_C1) + 1);
    curve.Intervals(breaks, GeomAbs_C1);
    std::vector<double> result(breaks.begin(), breaks.end());
    result.front() = edge.first_parameter;
    result.back() = edge.last_parameter;
    return result;
  });
}

Vec3 Model::face_point(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->face_point(id, uv);
  if (_data->joined) return _data->joined->evaluate(&Model::face_point, id, uv);
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->face_point(id - _data->first_faceted_face, uv);
  return _data->face_snaps.at(id)(_data->face_evaluators[id].surface.point(uv));
}

SurfaceFrame Model::face_frame(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->face_frame(id, uv);
  if (_data->joined) return _data->joined->evaluate(&Model::face_frame, id, uv);
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->face_frame(id - _data->first_faceted_face, uv);
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  const SurfaceJet jet = face.surface.jet(uv, 1);
  SurfaceFrame frame{_data->face_snaps[id](jet.point), jet.du, jet.dv, {}};
  const Vec3 normal = cross(frame.du, frame.dv);
  // Below this the angle between the derivatives is rounding error: the direction would be noise.
  if (norm(normal) > tolerances::rounding * std::max(dot(frame.du, frame.du), dot(frame.dv, frame.dv))) {
    frame.normal = face.reversed ? -normalized(normal) : normalized(normal);
  }
  return frame;
}

PrincipalCurvatures Model::face_curvatures(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->face_curvatures(id, uv);
  if (_data->joined) return _data->joined->evaluate(&Model::face_curvatures, id, uv);
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->face_curvatures(id - _data->first_faceted_face, uv);
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  if (face.planar) return {0, 0, true};
  return curvatures_of(face.surface.jet(uv, 2));
}

CurvedPoint Model::face_curved_point(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->face_curved_point(id, uv);
  if (_data->joined) return _data->joined->evaluate(&Model::face_curved_point, id, uv);
  if (_data->faceted_face(id)) return {face_point(id, uv), face_curvatures(id, uv)};
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  if (face.planar) return {face_point(id, uv), {0, 0, true}};
  const SurfaceJet jet = face.surface.jet(uv, 2);
  return {_data->face_snaps[id](jet.point), curvatures_of(jet)};
}

Vec2 Model::parameter_periods(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->model.parameter_periods(id, uv);
  if (_data->joined) return _data->joined->evaluate(&Model::parameter_periods, id, uv);
  if (_data->faceted_face(id)) return {};
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  return {face.u.repeats_after(), face.v.repeats_after()};
}

Vec2 Model::wrap(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->model.wrap(id, uv);
  if (const JoinedModel* joined = _data->joined.get()) {
    const JoinedModel::Place at = joined->locate(id, uv);
    return joined->faces[id].from_member(at.sheet, joined->base.wrap(at.face, at.uv));
  }
  if (_data->faceted_face(id)) return uv;
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  return {face.u.wrap(uv.x), face.v.wrap(uv.y)};
}

bool Model::is_planar(FaceId id) const {
  if (_data->scaled) return _data->scaled->model.is_planar(id);
  if (const JoinedModel* joined = _data->joined.get()) {
    const auto& sheets = joined->faces.at(id).sheets;
    return sheets.size() == 1 && joined->base.is_planar(sheets.front().face);
  }
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->faces()[id - _data->first_faceted_face].planar;
  return _data->face_evaluators.at(id).planar;
}

bool Model::is_exact_plane(FaceId id) const {
  if (_data->scaled) return _data->scaled->model.is_exact_plane(id);
  if (const JoinedModel* joined = _data->joined.get()) {
    const auto& sheets = joined->faces.at(id).sheets;
    return sheets.size() == 1 && joined->base.is_exact_plane(sheets.front().face);
  }
  const auto& fixed = _data->face_snaps.at(id).fixed;
  return fixed[0] || fixed[1] || fixed[2];
}

bool Model::is_faceted(FaceId id) const {
  if (_data->scaled) return _data->scaled->model.is_faceted(id);
  if (const JoinedModel* joined = _data->joined.get())
    return joined->base.is_faceted(joined->faces.at(id).sheets.front().face);
  return _data->faceted_face(id) != nullptr;
}

std::vector<FaceId> Model::members(FaceId id) const {
  if (_data->scaled) return _data->scaled->model.members(id);
  if (!_data->joined) return {id};
  std::vector<FaceId> faces;
  for (const Sheet& sheet : _data->joined->faces.at(id).sheets) faces.push_back(sheet.face);
  return faces;
}

std::int32_t Model::sheet_count(FaceId id) const {
  if (_data->scaled) return _data->scaled->model.sheet_count(id);
  if (const JoinedModel* joined = _data->joined.get()) {
    const auto& sheets = joined->faces.at(id).sheets;
    return sheets.size() > 1 ? static_cast<std::int32_t>(sheets.size())
                             : joined->base.sheet_count(sheets.front().face);
  }
  const FacetedGeometry* faceted = _data->faceted_face(id);
  return faceted ? faceted->faces()[id - _data->first_faceted_face].sheet_count : 1;
}

std::int32_t Model::sheet(FaceId id, Vec2 uv) const {
  if (_data->scaled) return _data->scaled->model.sheet(id, uv);
  if (const JoinedModel* joined = _data->joined.get()) {
    const JoinedModel::Place at = joined->locate(id, uv);
    return joined->faces[id].sheets.size() > 1 ? at.sheet : joined->base.sheet(at.face, at.uv);
  }
  const FacetedGeometry* faceted = _data->faceted_face(id);
  return faceted ? faceted->sheet(id - _data->first_faceted_face, uv) : 0;
}

bool Model::is_seam(EdgeId id) const {
  const Edge& edge = _data->edges.at(id);
  if (edge.faces.size() != 1) return false;
  int uses = 0;
  for (const Coedge& use : _data->faces[edge.faces.front()].loops | std::views::join) uses += use.edge == id;
  return uses > 1;
}

double Model::face_area(FaceId id) const {
  if (_data->scaled) return _data->scaled->face_area(id);
  if (const JoinedModel* joined = _data->joined.get()) {
    double area = 0;
    for (const Sheet& sheet : joined->faces.at(id).sheets) area += joined->base.face_area(sheet.face);
    return area;
  }
  return _data->integrals(id).area;
}

Vec3 Model::face_area_vector(FaceId id) const {
  if (_data->scaled) return _data->scaled->face_area_vector(id);
  const FaceIntegrals& sums = _data->integrals(id);
  return _data->is_reversed(id) ? -sums.area_vector : sums.area_vector;
}

FacePlace place_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties, area_precision);
  return {properties.Mass(), to_vec(properties.CentreOfMass()), tight_box(face)};
}

FacePlace Model::face_place(FaceId id) const {
  if (_data->scaled) return _data->scaled->face_place(id);
  if (const JoinedModel* joined = _data->joined.get()) {
    FacePlace whole;
    Vec3 moment;
    for (const Sheet& sheet : joined->faces.at(id).sheets) {
      const FacePlace place = joined->base.face_place(sheet.face);
      whole.area += place.area;
      moment = moment + place.area * place.centre;
      whole.box.add(place.box.low), whole.box.add(place.box.high);
    }
    whole.centre = 1 / whole.area * moment;
    return whole;
  }
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->face_place(id - _data->first_faceted_face);
  return guarded("looking where " + _data->describe_face(id) + " is",
                 [&] { return place_of(_data->face_evaluators.at(id).shape); });
}

double Model::region_volume(RegionId id) const {
  if (_data->scaled) return _data->scaled->region_volume(id);
  if (const JoinedModel* joined = _data->joined.get()) return joined->base.region_volume(id);
  // Seen from the middle of the region: from far off, what integrals lack is a part of areas times distances,
  // which may be more than the volume of a small region.
  Vec3 middle;
  double area = 0;
  for (FaceId f = 0; f < face_count(); ++f) {
    const Face& face = _data->faces[f];
    if (face.front != id && face.back != id) continue;
    const FaceIntegrals& sums = _data->integrals(f);
    middle += sums.moment;
    area += sums.area;
  }
  if (area > 0) middle = middle / area;
  double volume = 0;
  for (FaceId f = 0; f < face_count(); ++f) {
    const Face& face = _data->faces[f];
    if (face.front != id && face.back != id) continue;
    const FaceIntegrals& sums = _data->integrals(f);
    const double flux = sums.flux - dot(middle, sums.area_vector) / 3;
    // The flux is along du x dv; the normal points out of the front region.
    const double out_of_front = _data->is_reversed(f) ? -flux : flux;
    if (face.front == id) volume += out_of_front;
    if (face.back == id) volume -= out_of_front;
  }
  return volume;
}

bool Model::Data::is_reversed(FaceId id) const {
  return !faceted_face(id) && face_evaluators.at(id).reversed;
}

const FaceIntegrals& Model::Data::integrals(FaceId id) const {
  if (const FacetedGeometry* faceted = faceted_face(id)) {
    return cache->integrals(
        id, [&] { return integrate_facets(*faceted, id - first_faceted_face, bounds.center()); });
  }
  const FaceEvaluator& face = face_evaluators.at(id);
  return cache->integrals(id, [&] {
    return guarded("integrating the area of " + describe_face(id), [&] {
      FaceIntegrals found = integrate_face(face.shape, face.surface, bounds.center());
      found.moment = (found.area < 0 ? -1.0 : 1.0) * found.moment;
      found.area = std::abs(found.area);
      return found;
    });
  });
}

}  // namespace aeroloom::cad
