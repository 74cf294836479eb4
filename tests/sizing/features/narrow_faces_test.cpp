#include "sizing/features/narrow_faces.hpp"

#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using cad::Model;

std::vector<NarrowFace> find(const Model& model, double width, double tolerance) {
  return find_narrow_faces(parallel::Communicator::world(), model, width, tolerance);
}

TEST(NarrowFaces, AreFoundWithTheirNeighbours) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  const double width = 3 * std::numbers::pi / 180;
  EXPECT_TRUE(find(model, 0.9 * width, 1).empty());
  const auto found = find(model, 1.1 * width, 1e-6);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].width, width, 0.05 * width);
  EXPECT_LT(found[0].degrees, 1e-4);
  EXPECT_LT(found[0].deviation, 1e-6);
  EXPECT_FALSE(model.is_planar(found[0].into));
  EXPECT_NE(found[0].into, found[0].face);
  EXPECT_NEAR(std::hypot(found[0].place.x, found[0].place.y), 1, 1e-9);
  auto narrow = found;
  const auto groups = group_narrow_faces(model, narrow, 1e-6);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].size(), 2u);
}

TEST(NarrowFaces, ABluntTrailingEdgeStays) {
  const Model model = cad::shapes::blunt_wedge(0.01);
  EXPECT_TRUE(find(model, 0.02, 1).empty());
}

// A strip behind a bend is taken in while that moves the surface by less than the tolerance, and never where
// the surface turns by 20 degrees.
TEST(NarrowFaces, CreasesStay) {
  const Model bent = cad::shapes::creased_prism(10);
  const double deviation = 0.05 * std::sin(10 * std::numbers::pi / 180);
  const auto found = find(bent, 0.06, 1.2 * deviation);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].degrees, 10, 1e-6);
  EXPECT_NEAR(found[0].deviation, deviation, 0.1 * deviation);
  EXPECT_TRUE(find(bent, 0.06, 0.8 * deviation).empty());
  EXPECT_TRUE(find(cad::shapes::creased_prism(25), 0.06, 1).empty());
}

}  // namespace
}  // namespace aeroloom::sizing
