#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/evaluation/face_cache.hpp"
#include "cad/model/facets/corner_parameters.hpp"
#include "cad/model/facets/facet_refinement.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/topology/closed_edges_data.hpp"
#include "cad/model/topology/sheets.hpp"
#include "cad/tolerances.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A private copy of a face to triangulate. Edges remember the polygons of every face meshed before, and the
/// triangulator reuses them: on the face itself the result would depend on which neighbour was triangulated
/// first.
struct MeshedFace {
  TopoDS_Face face;
  BRepBuilderAPI_Copy copy;
  Handle(Poly_Triangulation) triangulation;
  TopLoc_Location location;
};

MeshedFace triangulate(const FaceEvaluator& evaluator, double deflection, double angle) {
  MeshedFace meshed;
  meshed.copy.Perform(evaluator.shape, false, false);
  meshed.face = TopoDS::Face(meshed.copy.Shape().Oriented(TopAbs_FORWARD));
  IMeshTools_Parameters parameters;
  parameters.Deflection = std::max(deflection, 2 * Precision::Confusion());
  parameters.Angle = angle;
  parameters.AngleInterior = angle;
  parameters.InParallel = false;
  parameters.AllowQualityDecrease = true;
  BRepMesh_IncrementalMesh mesher(meshed.face, parameters);
  meshed.triangulation = BRep_Tool::Triangulation(meshed.face, meshed.location);
  return meshed;
}

Facets::BoundaryLine boundary_line(const MeshedFace& meshed, const EdgeEvaluator& edge, const Coedge& use,
                                   bool second) {
  TopoDS_Edge copied = TopoDS::Edge(meshed.copy.ModifiedShape(edge.shape));
  copied.Orientation(second ? TopAbs_REVERSED : TopAbs_FORWARD);
  const Handle(Poly_PolygonOnTriangulation) polygon =
      BRep_Tool::PolygonOnTriangulation(copied, meshed.triangulation, meshed.location);
  Facets::BoundaryLine line{use, {}, {}};
  if (polygon.IsNull() || !polygon->HasParameters()) return line;
  for (int i = 1; i <= polygon->NbNodes(); ++i) {
    line.nodes.push_back(polygon->Node(i) - 1);
    line.parameters.push_back(polygon->Parameter(i));
  }
  if (line.parameters.front() > line.parameters.back()) {
    std::reverse(line.nodes.begin(), line.nodes.end());
    std::reverse(line.parameters.begin(), line.parameters.end());
  }
  return line;
}

Facets extract(const Model::Data& data, FaceId id, const MeshedFace& meshed) {
  const FaceEvaluator& evaluator = data.face_evaluators[id];
  Facets facets;
  if (meshed.triangulation.IsNull() || !meshed.triangulation->HasUVNodes()) return facets;
  const Poly_Triangulation& mesh = *meshed.triangulation;
  for (int i = 1; i <= mesh.NbNodes(); ++i) {
    const gp_Pnt2d uv = mesh.UVNode(i);
    const gp_Pnt point = mesh.Node(i).Transformed(meshed.location.Transformation());
    facets.uv.push_back({uv.X(), uv.Y()});
    facets.points.push_back(data.face_snaps[id]({point.X(), point.Y(), point.Z()}));
  }
  for (int i = 1; i <= mesh.NbTriangles(); ++i) {
    int a, b, c;
    mesh.Triangle(i).Get(a, b, c);
    facets.triangles.push_back({a - 1, b - 1, c - 1});
  }
  for (const UseCurve& use : evaluator.uses) {
    facets.boundary.push_back(
        boundary_line(meshed, data.edge_evaluators[use.use.edge], use.use, use.use.use == 1));
  }
  return facets;
}

/// Boundary nodes lie on their edges' curves; their parameters on the face come from there too, not from the
/// parameter curves, which may run at another pace. Where that would turn a triangle over, they stay.
void take_edge_parameters(const Model& model, FaceId id, Facets& facets) {
  const std::vector<Vec2> before = facets.uv;
  for (const Facets::BoundaryLine& line : facets.boundary) {
    for (std::size_t i = 1; i + 1 < line.nodes.size(); ++i) {
      facets.uv[line.nodes[i]] = model.edge_uv(id, line.use, line.parameters[i]);
    }
  }
  const auto positive = [](const std::vector<Vec2>& uv, const std::array<std::int32_t, 3>& t) {
    return orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) > 0;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : facets.triangles) {
      if (positive(facets.uv, t) || !positive(before, t)) continue;
      for (const std::int32_t node : t) {
        changed |= facets.uv[node] != before[node];
        facets.uv[node] = before[node];
      }
    }
  }
}

using FacetSide = std::pair<std::int32_t, std::int32_t>;

/// Directed sides of the triangles that no neighbour passes the other way, sorted.
std::vector<FacetSide> open_sides(const Facets& facets) {
  std::vector<FacetSide> sides;
  sides.reserve(3 * facets.triangles.size());
  for (const auto& t : facets.triangles) {
    for (int i = 0; i < 3; ++i) sides.emplace_back(t[i], t[(i + 1) % 3]);
  }
  std::sort(sides.begin(), sides.end());
  std::vector<FacetSide> open;
  for (const FacetSide& side : sides) {
    if (!std::binary_search(sides.begin(), sides.end(), FacetSide{side.second, side.first}))
      open.push_back(side);
  }
  return open;
}

/// The first defect of a triangulation; empty when there is none.
std::string find_defect(const Facets& facets) {
  if (facets.triangles.empty()) return "no triangles";
  std::vector<FacetSide> boundary;
  for (const auto& line : facets.boundary) {
    if (line.nodes.size() < 2) return fmt::format("edge {} missing on the boundary", line.use.edge);
    for (std::size_t i = 1; i < line.nodes.size(); ++i) {
      if (!(line.parameters[i] > line.parameters[i - 1])) {
        return fmt::format("edge {} passed out of order", line.use.edge);
      }
      boundary.emplace_back(std::minmax(line.nodes[i - 1], line.nodes[i]));
    }
  }
  std::sort(boundary.begin(), boundary.end());
  for (const FacetSide& side : open_sides(facets)) {
    if (!std::binary_search(boundary.begin(), boundary.end(),
                            FacetSide(std::minmax(side.first, side.second)))) {
      return fmt::format("a hole at {}", place_in_file(facets.points[side.first]));
    }
  }
  return {};
}

/// The fraction of the triangulation that is folded over in parameters.
double folded_fraction(const Facets& facets) {
  double forward = 0, backward = 0;
  for (const auto& t : facets.triangles) {
    const double area = cross(facets.uv[t[1]] - facets.uv[t[0]], facets.uv[t[2]] - facets.uv[t[0]]);
    (area > 0 ? forward : backward) += std::abs(area);
  }
  return std::min(forward, backward) / (forward + backward);
}

/// The best that the CAD library's triangulation can be made into.
Facets make_facets(const Model& model, FaceId id, double deflection, double angle, const std::string& doing) {
  const Model::Data& data = model.data();
  const FaceEvaluator& evaluator = data.face_evaluators[id];
  std::string defect;
  // The library leaves holes and folds at some deflections and not at others: a finer one is tried where it
  // did.
  for (const double fraction : {1.0, 0.5, 0.25, 0.1, 0.02}) {
    Facets facets = extract(data, id, triangulate(evaluator, fraction * deflection, angle));
    defect = find_defect(facets);
    if (defect.empty() && folded_fraction(facets) > tolerances::folded)
      defect = "facets folded over each other";
    if (!defect.empty()) continue;
    take_edge_parameters(model, id, facets);
    if (!evaluator.planar) refine_facets(model, id, deflection, angle, facets);
    spread_poles(model, id, facets);
    if (evaluator.reversed) {
      for (auto& t : facets.triangles) std::swap(t[1], t[2]);
    }
    return facets;
  }
  throw CadError(
      fmt::format("{}: the CAD library leaves {}; repair this face in the CAD program", doing, defect));
}

}  // namespace

Facets Model::facets(FaceId id, double deflection, double angle, Keep keep) const {
  if (_data->scaled) return _data->scaled->facets(id, deflection, angle, keep);
  if (_data->joined) return _data->joined->facets(id, deflection, angle, keep);
  if (const FacetedGeometry* faceted = _data->faceted_face(id)) {
    Facets facets = faceted->facets(id - _data->first_faceted_face);
    for (Facets::BoundaryLine& line : facets.boundary) line.use.edge += _data->first_faceted_edge;
    return facets;
  }
  FaceCache& cache = *_data->cache;
  if (const Facets* kept = cache.facets(id, deflection, angle)) return *kept;
  const std::string doing = "triangulating " + _data->describe_face(id);
  report_step(doing);
  const ClosedEdges* closed = _data->closed.get();
  Facets facets = closed ? closed->facets(*this, id, deflection, angle)
                         : guarded(doing, [&] { return make_facets(*this, id, deflection, angle, doing); });
  if (keep == Keep::yes) cache.keep(id, deflection, angle, facets);
  return facets;
}

std::vector<std::array<Vec2, 3>> corner_parameters(const Model& model, FaceId faceted) {
  const Model::Data& data = model.data();
  if (data.scaled) return corner_parameters(data.scaled->model, faceted);
  if (data.joined) return corner_parameters(data.joined->base, model.members(faceted).front());
  const FacetedGeometry& all = *data.faceted;
  const FacetedFace& face = all.faces().at(faceted - data.first_faceted_face);
  const auto first = all.corner_uv().begin() + face.first;
  return {first, first + face.count};
}

}  // namespace aeroloom::cad
