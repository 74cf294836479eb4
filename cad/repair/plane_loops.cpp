#include "cad/repair/plane_loops.hpp"

#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRepLib_FindSurface.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Plane.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>

namespace aeroloom::cad {
namespace {

/// Chords by which areas and distances from a plane are measured: a circle's area is short by 0.2 %.
constexpr int samples_per_edge = 64;

/// Visits points along a wire's edges, each edge in its own direction: calls `visit(first, second)` for
/// consecutive ones.
template <class Visit>
void for_each_chord(const TopoDS_Wire& wire, Visit&& visit) {
  for (TopoDS_Iterator edges(wire); edges.More(); edges.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(edges.Value());
    const BRepAdaptor_Curve curve(edge);
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    gp_Pnt before = curve.Value(first);
    for (int i = 1; i <= samples_per_edge; ++i) {
      const gp_Pnt next = curve.Value(first + (last - first) * i / samples_per_edge);
      if (edge.Orientation() == TopAbs_REVERSED) {
        visit(next, before);
      } else {
        visit(before, next);
      }
      before = next;
    }
  }
}

/// Enclosed area, positive where the wire runs counter-clockwise about the plane's normal. A sum over the
/// chords in any order.
double signed_area(const gp_Pln& plane, const TopoDS_Wire& wire) {
  double twice = 0;
  for_each_chord(wire, [&](const gp_Pnt& a, const gp_Pnt& b) {
    double ax, ay, bx, by;
    ElSLib::Parameters(plane, a, ax, ay);
    ElSLib::Parameters(plane, b, bx, by);
    twice += ax * by - bx * ay;
  });
  return 0.5 * twice;
}

double largest_deviation(const gp_Pln& plane, const TopoDS_Wire& wire) {
  double largest = 0;
  for_each_chord(wire,
                 [&](const gp_Pnt& a, const gp_Pnt&) { largest = std::max(largest, plane.Distance(a)); });
  return largest;
}

std::optional<std::vector<TopoDS_Wire>> chain_wires(const std::vector<TopoDS_Edge>& edges) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  for (const TopoDS_Edge& edge : edges) {
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    TopExp::MapShapesAndAncestors(forward, TopAbs_VERTEX, TopAbs_EDGE, users);
  }
  // A closed edge uses its vertex twice.
  for (int i = 1; i <= users.Extent(); ++i) {
    if (users(i).Extent() != 2) return std::nullopt;
  }
  std::vector<char> used(edges.size(), 0);
  std::vector<TopoDS_Wire> wires;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (used[first]) continue;
    BRepBuilderAPI_MakeWire wire(TopoDS::Edge(edges[first].Oriented(TopAbs_FORWARD)));
    used[first] = 1;
    const TopoDS_Vertex begin = TopExp::FirstVertex(edges[first]);
    TopoDS_Vertex end = TopExp::LastVertex(edges[first]);
    while (!end.IsSame(begin)) {
      std::size_t next = 0;
      while (next < edges.size() && (used[next] || (!TopExp::FirstVertex(edges[next]).IsSame(end) &&
                                                    !TopExp::LastVertex(edges[next]).IsSame(end)))) {
        ++next;
      }
      if (next == edges.size()) return std::nullopt;
      used[next] = 1;
      const bool forward = TopExp::FirstVertex(edges[next]).IsSame(end);
      wire.Add(TopoDS::Edge(edges[next].Oriented(forward ? TopAbs_FORWARD : TopAbs_REVERSED)));
      if (!wire.IsDone()) return std::nullopt;
      end = forward ? TopExp::LastVertex(edges[next]) : TopExp::FirstVertex(edges[next]);
    }
    wires.push_back(wire.Wire());
  }
  return wires;
}

std::optional<gp_Pln> fit_plane(const TopoDS_Wire& wire, double tolerance) {
  const BRepLib_FindSurface found(wire, tolerance, true);
  if (!found.Found()) return std::nullopt;
  const Handle(Geom_Plane) plane = Handle(Geom_Plane)::DownCast(found.Surface());
  if (plane.IsNull()) return std::nullopt;
  return plane->Pln().Transformed(found.Location().Transformation());
}

/// Whether a loop lies within another one of the same plane.
bool lies_within(const PlaneLoop& inner, const PlaneLoop& outer, double tolerance) {
  if (inner.area >= outer.area) return false;
  const TopoDS_Vertex vertex = TopExp::FirstVertex(TopoDS::Edge(TopoDS_Iterator(inner.wire).Value()));
  const gp_Pnt place = BRep_Tool::Pnt(vertex);
  if (outer.plane.Distance(place) > tolerance) return false;
  const TopoDS_Face face = make_plane_face(outer.plane, outer.wire, {});
  return BRepClass_FaceClassifier(face, place, tolerance).State() == TopAbs_IN;
}

void nest(std::vector<PlaneLoop>& loops, double tolerance) {
  const std::size_t count = loops.size();
  std::vector<std::vector<char>> within(count, std::vector<char>(count, 0));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i != j) loops[i].depth += within[i][j] = lies_within(loops[i], loops[j], tolerance);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (within[j][i] && loops[j].depth == loops[i].depth + 1)
        loops[i].children.push_back(static_cast<int>(j));
    }
  }
}

}  // namespace

std::optional<std::vector<std::vector<TopoDS_Edge>>> find_loops(const std::vector<TopoDS_Edge>& edges) {
  const auto wires = chain_wires(edges);
  if (!wires) return std::nullopt;
  std::vector<std::vector<TopoDS_Edge>> loops;
  for (const TopoDS_Wire& wire : *wires) {
    std::vector<TopoDS_Edge>& loop = loops.emplace_back();
    for (TopoDS_Iterator each(wire); each.More(); each.Next()) loop.push_back(TopoDS::Edge(each.Value()));
  }
  return loops;
}

std::optional<std::vector<PlaneLoop>> find_plane_loops(const std::vector<TopoDS_Edge>& edges,
                                                       double tolerance, const std::optional<gp_Pln>& plane) {
  const auto wires = chain_wires(edges);
  if (!wires) return std::nullopt;
  std::vector<PlaneLoop> loops;
  for (const TopoDS_Wire& wire : *wires) {
    const std::optional<gp_Pln> own = plane ? plane : fit_plane(wire, tolerance);
    if (!own) return std::nullopt;
    PlaneLoop loop{wire, *own, 0, 0, 0, {}};
    loop.deviation = largest_deviation(*own, wire);
    if (loop.deviation > tolerance) return std::nullopt;
    loop.area = std::abs(signed_area(*own, wire));
    loops.push_back(loop);
  }
  nest(loops, tolerance);
  return loops;
}

TopoDS_Face make_plane_face(const gp_Pln& plane, const TopoDS_Wire& outer,
                            const std::vector<TopoDS_Wire>& holes) {
  const auto oriented = [&](const TopoDS_Wire& wire, bool counter_clockwise) {
    return (signed_area(plane, wire) > 0) == counter_clockwise ? wire : TopoDS::Wire(wire.Reversed());
  };
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_Plane(plane), tolerances::library_length);
  builder.Add(face, oriented(outer, true));
  for (const TopoDS_Wire& hole : holes) builder.Add(face, oriented(hole, false));
  return face;
}

TopoDS_Face make_plane_face(const std::vector<PlaneLoop>& loops, std::size_t index) {
  std::vector<TopoDS_Wire> holes;
  for (const int child : loops[index].children) holes.push_back(loops[child].wire);
  return make_plane_face(loops[index].plane, loops[index].wire, holes);
}

std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance) {
  const auto loops = find_plane_loops(open, tolerance);
  if (!loops) return {};
  std::vector<Cap> caps;
  for (std::size_t i = 0; i < loops->size(); ++i) {
    if ((*loops)[i].depth % 2 != 0) continue;
    Cap& cap = caps.emplace_back();
    cap.face = make_plane_face(*loops, i);
    cap.deviation = (*loops)[i].deviation;
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(cap.face, properties);
    cap.center = to_vec(properties.CentreOfMass());
    cap.area = std::abs(properties.Mass());
  }
  return caps;
}

}  // namespace aeroloom::cad
