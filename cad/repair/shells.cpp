#include "cad/repair/shells.hpp"

#include "cad/model/model_data.hpp"

#include <cstddef>

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

/// A shell as a body of its own.
struct Body {
  TopoDS_Solid solid;
  Box box;
};

bool box_inside(const Box& inner, const Box& outer) {
  return outer.contains(inner.low) && outer.contains(inner.high);
}

/// Whether one body lies inside another that it does not cross: the first of its vertices not on the other's
/// surface decides.
bool lies_inside(const Body& inner, const Body& outer, double tolerance) {
  if (!box_inside(inner.box, outer.box)) return false;
  BRepClass3d_SolidClassifier classifier(outer.solid);
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(inner.solid, TopAbs_VERTEX, vertices);
  for (int i = 1; i <= vertices.Extent(); ++i) {
    classifier.Perform(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i))), tolerance);
    if (classifier.State() == TopAbs_IN) return true;
    if (classifier.State() == TopAbs_OUT) return false;
  }
  return false;
}

TopoDS_Shell shell_of(const TopoDS_Solid& solid) {
  return TopoDS::Shell(TopExp_Explorer(solid, TopAbs_SHELL).Current());
}

}  // namespace

bool is_closed(const TopoDS_Shell& shell) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndAncestors(shell, TopAbs_EDGE, TopAbs_FACE, users);
  for (int i = 1; i <= users.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i));
    const bool inside_a_face = edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED;
    // A face is listed once per passage, so a seam counts twice.
    if (!BRep_Tool::Degenerated(edge) && !inside_a_face && users(i).Extent() < 2) return false;
  }
  return !users.IsEmpty();
}

TopoDS_Solid solid_of(const TopoDS_Shell& shell, Volumes& volumes) {
  TopoDS_Shell closed = TopoDS::Shell(shell.Oriented(TopAbs_FORWARD));
  closed.Closed(true);
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(closed).Solid();
  if (volumes.of(solid) < 0) {
    solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(closed.Reversed())).Solid();
  }
  return solid;
}

std::vector<TopoDS_Solid> nest_shells(const std::vector<TopoDS_Shell>& shells, Volumes& volumes) {
  std::vector<Body> bodies;
  Box all;
  for (const TopoDS_Shell& shell : shells) {
    const TopoDS_Solid solid = solid_of(shell, volumes);
    bodies.push_back({solid, shells.size() > 1 ? tight_box(solid) : Box{}});
    all.add(bodies.back().box);
  }
  const std::size_t count = bodies.size();
  std::vector<std::vector<char>> inside(count, std::vector<char>(count, 0));
  std::vector<int> depth(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i != j) depth[i] += inside[i][j] = lies_inside(bodies[i], bodies[j], 1e-9 * all.diagonal());
    }
  }
  std::vector<TopoDS_Solid> solids;
  for (std::size_t i = 0; i < count; ++i) {
    if (depth[i] % 2 != 0) continue;
    TopoDS_Solid solid;
    BRep_Builder builder;
    builder.MakeSolid(solid);
    builder.Add(solid, shell_of(bodies[i].solid));
    for (std::size_t j = 0; j < count; ++j) {
      if (inside[j][i] && depth[j] == depth[i] + 1) builder.Add(solid, shell_of(bodies[j].solid).Reversed());
    }
    solids.push_back(solid);
  }
  return solids;
}

}  // namespace aeroloom::cad
