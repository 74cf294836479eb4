#include "geometry/caps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRepLib_FindSurface.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Plane.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::geometry {
namespace {

/// One opening: its edges as a closed wire, and the face over it without regard to other openings.
struct Opening {
  TopoDS_Wire wire;
  gp_Pln plane;
  TopoDS_Face face;
  double area = 0, deviation = 0;
};

/// Chains edges that share vertices to closed wires; nothing where a vertex has other than two of them.
std::optional<std::vector<TopoDS_Wire>> chain_wires(const std::vector<TopoDS_Edge>& edges) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  for (const TopoDS_Edge& edge : edges)
    TopExp::MapShapesAndAncestors(edge, TopAbs_VERTEX, TopAbs_EDGE, users);
  for (int i = 1; i <= users.Extent(); ++i) {
    if (users(i).Extent() != 2) return std::nullopt;
  }
  std::vector<char> used(edges.size(), 0);
  std::vector<TopoDS_Wire> wires;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (used[first]) continue;
    BRepBuilderAPI_MakeWire wire(edges[first]);
    used[first] = 1;
    const TopoDS_Vertex begin = TopExp::FirstVertex(edges[first]);
    TopoDS_Vertex end = TopExp::LastVertex(edges[first]);
    while (!end.IsSame(begin)) {
      const auto next = std::find_if(edges.begin(), edges.end(), [&](const TopoDS_Edge& edge) {
        return !used[&edge - edges.data()] &&
               (TopExp::FirstVertex(edge).IsSame(end) || TopExp::LastVertex(edge).IsSame(end));
      });
      if (next == edges.end()) return std::nullopt;
      used[next - edges.begin()] = 1;
      wire.Add(*next);
      if (!wire.IsDone()) return std::nullopt;
      end = TopExp::FirstVertex(*next).IsSame(end) ? TopExp::LastVertex(*next) : TopExp::FirstVertex(*next);
    }
    wires.push_back(wire.Wire());
  }
  return wires;
}

/// Largest distance of a wire's edges from a plane, by samples.
double distance_from(const gp_Pln& plane, const TopoDS_Wire& wire) {
  constexpr int samples = 32;
  double largest = 0;
  for (TopoDS_Iterator edges(wire); edges.More(); edges.Next()) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edges.Value()));
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    for (int i = 0; i <= samples; ++i) {
      largest = std::max(largest, plane.Distance(curve.Value(first + (last - first) * i / samples)));
    }
  }
  return largest;
}

std::optional<Opening> make_opening(const TopoDS_Wire& wire, double tolerance) {
  const BRepLib_FindSurface found(wire, tolerance, true);
  if (!found.Found()) return std::nullopt;
  const Handle(Geom_Plane) plane = Handle(Geom_Plane)::DownCast(found.Surface());
  if (plane.IsNull()) return std::nullopt;
  Opening opening{wire, plane->Pln(), {}, 0, 0};
  opening.plane.Transform(found.Location().Transformation());
  opening.deviation = distance_from(opening.plane, wire);
  if (opening.deviation > tolerance) return std::nullopt;
  BRepBuilderAPI_MakeFace face(opening.plane, wire, true);
  if (!face.IsDone()) return std::nullopt;
  opening.face = face.Face();
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(opening.face, properties);
  opening.area = std::abs(properties.Mass());
  return opening;
}

/// Whether an opening lies within another one of the same plane.
bool lies_within(const Opening& inner, const Opening& outer, double tolerance) {
  if (inner.area >= outer.area) return false;
  const TopoDS_Vertex vertex = TopExp::FirstVertex(TopoDS::Edge(TopoDS_Iterator(inner.wire).Value()));
  const gp_Pnt place = BRep_Tool::Pnt(vertex);
  if (outer.plane.Distance(place) > tolerance) return false;
  return BRepClass_FaceClassifier(outer.face, place, tolerance).State() == TopAbs_IN;
}

/// The face of an opening with those directly inside it as holes.
Cap make_cap(const std::vector<Opening>& openings, const std::vector<std::vector<char>>& within,
             const std::vector<int>& depth, std::size_t index) {
  BRepBuilderAPI_MakeFace face(openings[index].face);
  Cap cap;
  cap.deviation = openings[index].deviation;
  for (std::size_t j = 0; j < openings.size(); ++j) {
    if (!within[j][index] || depth[j] != depth[index] + 1) continue;
    TopoDS_Wire hole = openings[j].wire;
    for (TopoDS_Iterator own(openings[j].face); own.More(); own.Next()) hole = TopoDS::Wire(own.Value());
    const bool alike = openings[j].face.Orientation() == openings[index].face.Orientation() &&
                       openings[j].plane.Axis().Direction().Dot(openings[index].plane.Axis().Direction()) > 0;
    face.Add(alike ? TopoDS::Wire(hole.Reversed()) : hole);
    cap.deviation = std::max(cap.deviation, openings[j].deviation);
  }
  cap.face = face.Face();
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(cap.face, properties);
  const gp_Pnt center = properties.CentreOfMass();
  cap.center = {center.X(), center.Y(), center.Z()};
  cap.area = std::abs(properties.Mass());
  return cap;
}

}  // namespace

std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance) {
  const auto wires = chain_wires(open);
  if (!wires) return {};
  std::vector<Opening> openings;
  for (const TopoDS_Wire& wire : *wires) {
    const std::optional<Opening> opening = make_opening(wire, tolerance);
    if (!opening) return {};
    openings.push_back(*opening);
  }
  const std::size_t count = openings.size();
  std::vector<std::vector<char>> within(count, std::vector<char>(count, 0));
  std::vector<int> depth(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i != j) depth[i] += within[i][j] = lies_within(openings[i], openings[j], tolerance);
    }
  }
  std::vector<Cap> caps;
  for (std::size_t i = 0; i < count; ++i) {
    if (depth[i] % 2 == 0) caps.push_back(make_cap(openings, within, depth, i));
  }
  return caps;
}

}  // namespace aeroloom::geometry
