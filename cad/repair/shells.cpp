#include "cad/repair/shells.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepClass3d.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::cad {
namespace {

/// A shell as a body of its own.
struct Body {
  TopoDS_Solid solid;
  Box box;
};

/// Points of a shape's edges, evenly among them: their ends and three between.
std::vector<gp_Pnt> points_on_edges(const TopoDS_Shape& shape) {
  constexpr int most_edges = 40, steps = 4;  // some 200 points where few decide; chosen, not measured
  const TopTools_IndexedMapOfShape edges = map_of(shape, TopAbs_EDGE);
  const int stride = std::max(1, edges.Extent() / most_edges);
  std::vector<gp_Pnt> points;
  for (int i = 1; i <= edges.Extent(); i += stride) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    for (int k = 0; k <= steps; ++k) points.push_back(curve.Value(first + (last - first) * k / steps));
  }
  return points;
}

enum class Place { inside, outside, on_surface };

/// Where a body lies that does not cross the solid: most of its points not on the solid's surface decide. One
/// alone does not: the classifier's rays err where they graze an edge of large tolerance.
Place place_of(const TopoDS_Shape& body, const TopoDS_Solid& solid, double tolerance) {
  constexpr int lead = 4;  // more than the rays that graze one edge can be wrong; chosen, not measured
  BRepClass3d_SolidClassifier classifier(solid);
  int balance = 0;
  for (const gp_Pnt& point : points_on_edges(body)) {
    classifier.Perform(point, tolerance);
    balance += (classifier.State() == TopAbs_IN) - (classifier.State() == TopAbs_OUT);
    if (std::abs(balance) >= lead) break;
  }
  if (balance == 0) return Place::on_surface;
  return balance > 0 ? Place::inside : Place::outside;
}

bool lies_inside(const Body& inner, const Body& outer, double tolerance) {
  return outer.box.contains(inner.box) && place_of(inner.solid, outer.solid, tolerance) == Place::inside;
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
    // A face is listed once per coedge, so a seam counts twice.
    if (!BRep_Tool::Degenerated(edge) && bounds_material(edge) && users(i).Extent() < 2) return false;
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
      if (i != j)
        depth[i] += inside[i][j] = lies_inside(bodies[i], bodies[j], tolerances::coincident * all.diagonal());
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

int count_in_cavities(const std::vector<TopoDS_Solid>& solids, Volumes& volumes) {
  std::vector<Body> outlines;
  Box all;
  for (const TopoDS_Solid& solid : solids) {
    const TopoDS_Shell outer = BRepClass3d::OuterShell(solid);
    outlines.push_back({outer.IsNull() ? solid : solid_of(outer, volumes), tight_box(solid)});
    all.add(outlines.back().box);
  }
  const double tolerance = tolerances::coincident * all.diagonal();
  int count = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = 0; j < solids.size(); ++j) {
      if (i == j || !lies_inside(outlines[i], outlines[j], tolerance)) continue;
      if (place_of(solids[i], solids[j], tolerance) == Place::inside) continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace aeroloom::cad
