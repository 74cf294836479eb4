#include "cad/repair/repair_edges.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <BRepCheck_Analyzer.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom_Curve.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double tolerance = 1e-7, two_pi = 2 * std::numbers::pi;

/// A circle between the side and an end of a cylinder, with the side.
struct Rim {
  TopoDS_Edge edge;
  TopoDS_Face side;
};

Rim find_rim(const TopoDS_Shape& cylinder) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndUniqueAncestors(cylinder, TopAbs_EDGE, TopAbs_FACE, users);
  for (int i = 1; i <= users.Extent(); ++i) {
    if (users(i).Extent() != 2) continue;
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i));
    for (const TopoDS_Shape& face : users(i)) {
      double first, last;
      const auto curve = BRep_Tool::CurveOnSurface(edge, TopoDS::Face(face), first, last);
      if (!curve.IsNull() && std::abs(curve->Value(first).Distance(curve->Value(last)) - two_pi) < 1e-9)
        return {edge, TopoDS::Face(face)};
    }
  }
  return {};
}

/// Largest distance between the edge and its image on the face at equal parameters.
double distance_apart(const Rim& rim) {
  double first, last, low, high;
  const auto curve = BRep_Tool::Curve(rim.edge, first, last);
  const auto image = BRep_Tool::CurveOnSurface(rim.edge, rim.side, low, high);
  const auto surface = BRep_Tool::Surface(rim.side);
  double largest = 0;
  for (int i = 0; i <= 100; ++i) {
    const double t = first + (last - first) * i / 100;
    const gp_Pnt2d uv = image->Value(t);
    largest = std::max(largest, curve->Value(t).Distance(surface->Value(uv.X(), uv.Y())));
  }
  return largest;
}

class RepairEdges : public testing::Test {
protected:
  TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(1, 2).Shape();
  Rim rim = find_rim(cylinder);
  BRep_Builder builder;
  Changes changes;

  void SetUp() override { ASSERT_FALSE(rim.edge.IsNull()); }
};

TEST_F(RepairEdges, LeavesSoundShapesAlone) {
  repair_edges(cylinder, tolerance, changes);
  // The ends of a sphere's seam are degenerate edges, which have no curve in space.
  repair_edges(BRepPrimAPI_MakeSphere(1).Shape(), tolerance, changes);
  EXPECT_TRUE(changes.empty()) << changes.front().what;
}

TEST_F(RepairEdges, GivesTheCurveInSpaceThatIsMissing) {
  builder.UpdateEdge(rim.edge, Handle(Geom_Curve)(), tolerance);
  double first, last;
  ASSERT_TRUE(BRep_Tool::Curve(rim.edge, first, last).IsNull());
  repair_edges(cylinder, tolerance, changes);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].what, "1 edges got the curve they lacked");
  EXPECT_FALSE(BRep_Tool::Curve(rim.edge, first, last).IsNull());
  EXPECT_LT(distance_apart(rim), tolerance);
}

TEST_F(RepairEdges, GivesTheParameterCurveThatIsMissing) {
  builder.UpdateEdge(rim.edge, Handle(Geom2d_Curve)(), rim.side, tolerance);
  double first, last;
  ASSERT_TRUE(BRep_Tool::CurveOnSurface(rim.edge, rim.side, first, last).IsNull());
  repair_edges(cylinder, tolerance, changes);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].what, "1 edges got the parameter curve they lacked on a face");
  EXPECT_FALSE(BRep_Tool::CurveOnSurface(rim.edge, rim.side, first, last).IsNull());
  EXPECT_LT(distance_apart(rim), 10 * tolerance);
}

TEST_F(RepairEdges, FitsParameterCurvesThatRunAtAnotherPace) {
  double first, last;
  const auto image = BRep_Tool::CurveOnSurface(rim.edge, rim.side, first, last);
  constexpr int samples = 40;
  Handle(TColgp_HArray1OfPnt2d) points = new TColgp_HArray1OfPnt2d(1, samples + 1);
  Handle(TColStd_HArray1OfReal) at = new TColStd_HArray1OfReal(1, samples + 1);
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples, late = t + 0.05 * std::sin(two_pi * t);
    points->SetValue(i + 1, image->Value(first + (last - first) * late));
    at->SetValue(i + 1, first + (last - first) * t);
  }
  Geom2dAPI_Interpolate other_pace(points, at, false, 0);
  other_pace.Perform();
  builder.UpdateEdge(rim.edge, other_pace.Curve(), rim.side, tolerance);
  ASSERT_GT(distance_apart(rim), 0.1);
  repair_edges(cylinder, 1e-4, changes);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_NE(changes[0].what.find("1 parameter curves left their edges"), std::string::npos)
      << changes[0].what;
  EXPECT_LT(distance_apart(rim), 1e-4);
}

}  // namespace
}  // namespace aeroloom::cad
