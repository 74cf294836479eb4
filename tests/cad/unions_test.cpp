// Pairs of bodies that coincide in faces, touch, or nearly do: united soundly, or named.
#include "cad/domain/booleans.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double pi = std::numbers::pi;

TopoDS_Shape box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}
/// Along z.
TopoDS_Shape cylinder(gp_Pnt foot, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(foot, gp_Dir(0, 0, 1)), radius, height).Shape();
}

struct Pair {
  const char* name;
  TopoDS_Shape first, second;
  double volume;  ///< of the union
};

std::vector<Pair> pairs() {
  const TopoDS_Shape unit = box({0, 0, 0}, {1, 1, 1}), round = cylinder({0, 0, 0}, 1, 2);
  return {
      {"boxes with a face in common", unit, box({1, 0, 0}, {2, 1, 1}), 2},
      {"boxes with parts of faces in common", unit, box({1, 0.3, -0.2}, {2, 1.4, 0.7}), 1 + 1.1 * 0.9},
      {"boxes whose faces are 1e-6 apart inside", unit, box({1 - 1e-6, 0, 0}, {2, 1, 1}), 2},
      {"boxes shifted by 1e-6 along their common face", unit, box({1, 1e-6, 1e-6}, {2, 1 + 1e-6, 1 + 1e-6}),
       2},
      {"cylinders one above the other", round, cylinder({0, 0, 2}, 1, 1), 3 * pi},
      {"cylinders that overlap on one axis", round, cylinder({0, 0, 1}, 1, 2), 3 * pi},
      {"cylinders that overlap with axes 1e-6 apart", round, cylinder({1e-6, 0, 1}, 1, 2), 3 * pi},
      {"a cylinder that touches one around it along a line", round, cylinder({0.5, 0, -1}, 0.5, 4),
       2 * pi + 0.25 * pi * 2},
      {"cylinders that touch along a line", round, cylinder({2, 0, 0}, 1, 2), 4 * pi},
      {"a cylinder within a box, tangent to four sides", box({-1, -1, 0}, {1, 1, 1}),
       cylinder({0, 0, -1}, 1, 3), 4 + 2 * pi},
      {"a ball on a plane", unit, BRepPrimAPI_MakeSphere(gp_Pnt(0.5, 0.5, 1.25), 0.25).Shape(), 1 + pi / 48},
      {"a cone that stands on its apex", unit,
       BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0.5, 0.5, 1), gp_Dir(0, 0, 1)), 0, 0.3, 1).Shape(), 1 + 0.03 * pi},
      {"a torus around a cylinder that touches it", round,
       BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 1), gp_Dir(0, 0, 1)), 1.2, 0.2).Shape(),
       2 * pi + 2 * pi * pi * 1.2 * 0.04},
  };
}

TEST(Unions, AreSoundOrNameBothBodiesAndAPlace) {
  int united = 0;
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    try {
      const Domain domain = shapes::prepare(shapes::compound_of<TopoDS_Shape>({pair.first, pair.second}),
                                            {.kind = DomainKind::body});
      checks::expect_watertight(domain.model);
      const Vec3 size = domain.model.bounds().size();
      const double far_field = pi / 6 * std::pow(size.x, 3);
      EXPECT_NEAR(far_field - domain.model.region_volume(0), pair.volume,
                  1e-3 * pair.volume + 1e-6 * far_field);
      ++united;
    } catch (const CadError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("bodies"), std::string::npos) << text;
      EXPECT_NE(text.find("near ("), std::string::npos) << text;
      EXPECT_NE(text.find("Remedy"), std::string::npos) << text;
      std::printf("%s: %s\n", pair.name, error.what());
    }
  }
  EXPECT_GE(united, 9);
}

/// Twenty boxes on a plate.
std::vector<TopoDS_Solid> boxes_on_a_plate() {
  std::vector<TopoDS_Solid> solids{BRepPrimAPI_MakeBox({-1, -1, -1}, {21, 2, 0}).Solid()};
  for (int i = 0; i < 20; ++i)
    solids.push_back(BRepPrimAPI_MakeBox({1. * i, 0, 0}, {i + 0.5, 1, 0.1 + 0.01 * i}).Solid());
  return solids;
}

TEST(Unions, ManyThatTouchAreUnitedAtOnce) {
  const std::vector<TopoDS_Solid> solids = boxes_on_a_plate();
  Volumes volumes;
  FaceLabels labels;
  for (const TopoDS_Solid& solid : solids)
    for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next())
      labels.Bind(faces.Current(), FaceLabel{.solid = &solid == &solids.front() ? "plate" : "chip"});
  const auto united = unite_at_once(solids, volumes, labels);
  ASSERT_TRUE(united);
  ASSERT_EQ(united->size(), 1U);
  EXPECT_NEAR(volumes.of(united->front()), volume_of(solids, volumes), 1e-9);
  int plate = 0, chips = 0;
  for (TopExp_Explorer faces(united->front(), TopAbs_FACE); faces.More(); faces.Next()) {
    const FaceLabel* label = labels.Seek(faces.Current());
    ASSERT_NE(label, nullptr);
    (label->solid == "plate" ? plate : chips) += 1;
  }
  EXPECT_EQ(plate, 6);
  EXPECT_EQ(chips, 20 * 5);
}

TEST(Unions, ManyOfWhichSomeOverlapAreNotUnitedAtOnce) {
  std::vector<TopoDS_Solid> solids = boxes_on_a_plate();
  solids.push_back(BRepPrimAPI_MakeBox({0.2, 0.2, 0}, {0.4, 0.4, 1}).Solid());
  Volumes volumes;
  FaceLabels labels;
  EXPECT_FALSE(unite_at_once(solids, volumes, labels));
}

}  // namespace
}  // namespace aeroloom::cad
