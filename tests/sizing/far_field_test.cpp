// Which faces of a fluid are far field, and which are walls.
#include "sizing/features/far_field.hpp"

#include "tests/cad/cad_shapes.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

TopoDS_Shape box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}

TopoDS_Shape ball(gp_Pnt center, double radius) {
  return BRepPrimAPI_MakeSphere(center, radius).Shape();
}

cad::Model fluid(const TopoDS_Shape& outer, const TopoDS_Shape& body) {
  return cad::shapes::prepare_fluid(BRepAlgoAPI_Cut(outer, body).Shape()).model;
}

FarFieldFaces far_field_of(const cad::Model& model, const std::vector<FaceRole>& roles = {}) {
  return find_far_field(parallel::Communicator::world(), model, roles);
}

int far_count(const cad::Model& model, const std::vector<FaceRole>& roles = {}) {
  const FarFieldFaces far = far_field_of(model, roles);
  EXPECT_FALSE(far.decision.empty());
  return static_cast<int>(std::count(far.faces.begin(), far.faces.end(), true));
}

TEST(FarField, IsABoxThatIsAtLeastThreeTimesAsLargeAsItsBody) {
  const auto around = [](double half) {
    return fluid(box({-half, -half, -half}, {half, half, half}), ball({0, 0, 0}, 0.5));
  };
  EXPECT_EQ(far_count(around(5)), 6);
  EXPECT_EQ(far_count(around(1.501)), 6);
  const cad::Model close = around(1.4);
  EXPECT_EQ(far_count(close), 0);
  EXPECT_NE(far_field_of(close).decision.find("its side xmin is 1.4 from the middle of the body"),
            std::string::npos)
      << far_field_of(close).decision;
}

// A long body counts with its length in all directions.
TEST(FarField, IsFarOnEachSide) {
  const TopoDS_Shape wing = box({-0.5, -4, -0.1}, {0.5, 4, 0.1});
  EXPECT_EQ(far_count(fluid(box({-20, -20, -20}, {20, 20, 20}), wing)), 6);
  EXPECT_EQ(far_count(fluid(box({-20, -4.5, -20}, {20, 4.5, 20}), wing)), 0);
  EXPECT_EQ(far_count(fluid(box({-20, -20, -1}, {20, 20, 1}), wing)), 0);
}

TEST(FarField, MayBeTouchedOnOneSide) {
  const TopoDS_Shape outer = box({-9, 0, -9}, {9, 9, 9});
  EXPECT_EQ(far_count(fluid(outer, ball({0, 0, 0}, 1))), 6) << "half of a body at its plane of symmetry";
  EXPECT_EQ(far_count(fluid(outer, ball({0, 1.01, 0}, 1))), 6) << "a body near the ground";
  EXPECT_EQ(far_count(fluid(outer, box({-1, -1, -0.5}, {0, 10, 0.5}))), 0) << "a pillar from wall to wall";
}

TEST(FarField, IsNoWallOfADuct) {
  EXPECT_EQ(far_count(cad::shapes::prepare_fluid(box({0, 0, 0}, {4, 1, 1})).model), 0);
  const cad::Model bend = fluid(box({0, 0, 0}, {4, 4, 1}), box({1, 1, -1}, {5, 5, 2}));
  EXPECT_EQ(far_count(bend), 0);
  EXPECT_NE(far_field_of(bend).decision.find("holds no body"), std::string::npos);
}

TEST(FarField, IsHalfOfASphereOrACylinder) {
  const TopoDS_Shape half =
      BRepPrimAPI_MakeSphere(gp_Ax2({0, 0, 0}, {0, 1, 0}), 9, 0, 1.5707963267948966).Shape();
  EXPECT_EQ(far_count(fluid(half, ball({0, 0, 0}, 1))), 2);
  const cad::Model whole = fluid(ball({1, 2, 3}, 9), box({0, 1, 2}, {2, 3, 4}));
  EXPECT_EQ(far_count(whole), 1);
  const TopoDS_Shape tube = BRepPrimAPI_MakeCylinder(gp_Ax2({-9, 0, 0}, {1, 0, 0}), 9, 18).Shape();
  EXPECT_EQ(far_count(fluid(tube, ball({0, 0, 0}, 1))), 3);
  const TopoDS_Shape half_tube = BRepAlgoAPI_Cut(tube, box({-10, -10, -10}, {10, 0, 10})).Shape();
  EXPECT_EQ(far_count(fluid(half_tube, ball({0, 0, 0}, 1))), 4) << "a body on the plane of symmetry";
  EXPECT_EQ(far_count(fluid(half_tube, ball({0, 0, 0}, 4))), 0);
}

// Corners of the faces that cut something off lie on the shape.
TEST(FarField, HasNoNotch) {
  const TopoDS_Shape tube = BRepPrimAPI_MakeCylinder(gp_Ax2({-9, 0, 0}, {1, 0, 0}), 9, 18).Shape();
  const TopoDS_Shape other = BRepAlgoAPI_Cut(tube, box({5, 5, -9}, {10, 10, 9})).Shape();
  const cad::Model cut = fluid(other, ball({0, 0, 0}, 1));
  EXPECT_EQ(far_count(cut), 0);
  EXPECT_NE(far_field_of(cut).decision.find("is no box, sphere, cylinder"), std::string::npos);
}

TEST(FarField, IsWhatHasItsType) {
  const cad::Model duct = cad::shapes::prepare_fluid(box({0, 0, 0}, {4, 1, 1})).model;
  std::vector<FaceRole> roles(6, FaceRole::open);
  roles[1] = FaceRole::symmetry;
  EXPECT_EQ(far_count(duct, roles), 0);
  roles[0] = FaceRole::far_field;
  EXPECT_EQ(far_count(duct, roles), 2) << "with the plane of symmetry";
  EXPECT_EQ(far_field_of(duct, roles).decision, "2 faces by type");
  const cad::Model open = fluid(box({-9, -9, -9}, {9, 9, 9}), ball({0, 0, 0}, 1));
  std::vector<FaceRole> walls(static_cast<std::size_t>(open.face_count()), FaceRole::wall);
  EXPECT_EQ(far_count(open, walls), 0);
}

}  // namespace
}  // namespace aeroloom::sizing
