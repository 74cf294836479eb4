// Answers of shapes against formulas, and what holds of all of them.
#include "sizing/sources/size_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

const std::vector<SolidShape> one_of_each{PointShape{{1, -2, 0.5}},
                                          LineShape{{0, 0, 0}, {4, 1, 2}},
                                          SphereShape{{1, 2, 3}, 1.5},
                                          BoxShape{{3, -1, 2}, {-1, 1, 5}},
                                          CylinderShape{{0, 3, 0}, {4, 3, 1}, 0.75},
                                          ConeShape{{0, 0, 0}, {4, 0, 0}, 1, 2}};

TEST(SizeShapes, TellHowFarAPointIs) {
  const ConeShape cone{{0, 0, 0}, {4, 0, 0}, 1, 2};
  EXPECT_EQ(cone.distance_to({2, 1.4, 0}), 0);
  EXPECT_NEAR(cone.distance_to({-1, 0.5, 0}), 1, 1e-12);
  EXPECT_NEAR(cone.distance_to({5, 0, 2}), 1, 1e-12);
  EXPECT_NEAR(cone.distance_to({0, 0, 2}), 1 / std::hypot(1, 0.25), 1e-12);  // to the slope
  EXPECT_NEAR(cone.distance_to({-3, 0, 5}), 5, 1e-12);                       // to the rim
  const SphereShape ball{{1, 2, 3}, 1.5};
  EXPECT_EQ(ball.distance_to({1, 2, 4}), 0);
  EXPECT_NEAR(ball.distance_to({1, 2, 6}), 1.5, 1e-12);
  const BoxShape box{{3, -1, 2}, {-1, 1, 5}};
  EXPECT_EQ(box.distance_to({0, 0, 3}), 0);
  EXPECT_NEAR(box.distance_to({6, 0, 9}), 5, 1e-12);
  const LineShape line{{0, 0, 0}, {4, 0, 0}};
  EXPECT_NEAR(line.distance_to({2, 3, 4}), 5, 1e-12);
  EXPECT_NEAR(line.distance_to({7, 0, 4}), 5, 1e-12);
  const CylinderShape cylinder{{0, 0, 0}, {4, 0, 0}, 1};
  EXPECT_EQ(cylinder.distance_to({1, 0.6, 0.6}), 0);
  EXPECT_NEAR(cylinder.distance_to({1, 0, 3}), 2, 1e-12);
  EXPECT_NEAR(cylinder.distance_to({8, 4, 0}), 5, 1e-12);  // to the rim
  EXPECT_NEAR((PointShape{{1, 1, 1}}).distance_to({1, 4, 5}), 5, 1e-12);
  // Without an axis, a ball is left.
  EXPECT_NEAR((CylinderShape{{1, 2, 3}, {1, 2, 3}, 1.5}).distance_to({1, 2, 6}), 1.5, 1e-12);
}

TEST(SizeShapes, LieInTheirBoxes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-8, 8);
  for (const SolidShape& shape : one_of_each) {
    const geometry::Box box = box_of(shape);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p{place(random), place(random), place(random)};
      double away = 0;
      for (int axis = 0; axis < 3; ++axis)
        away = std::max({away, box.low[axis] - p[axis], p[axis] - box.high[axis]});
      EXPECT_GE(distance_to(shape, p), away - 1e-12) << "shape " << shape.index();
    }
  }
}

TEST(SizeShapes, BoundTheirCellsWhereTheirBoxIsTooLarge) {
  // The box of a diagonal holds 64^3 cubes, of which the line meets some 190.
  const double edge = 0.125;
  const LineShape line{{0, 0, 0}, {8, 8, 8}};
  EXPECT_GE(line.cells(edge), 190);
  EXPECT_LE(line.cells(edge), 500);
  const CylinderShape cylinder{{0, 0, 0}, {8, 8, 8}, 1};
  const double volume = std::acos(-1) * norm(cylinder.to);
  EXPECT_GE(cylinder.cells(edge), volume / std::pow(edge, 3));
  EXPECT_LE(cylinder.cells(edge), 1.5 * volume / std::pow(edge, 3));
  const ConeShape cone{{0, 0, 0}, {8, 8, 8}, 0.5, 1};
  EXPECT_EQ(cone.cells(edge), cylinder.cells(edge));
  EXPECT_EQ((PointShape{}).cells(edge), std::numeric_limits<double>::infinity());
}

/// A length without a place in scaled() would move the surface.
TEST(SizeShapes, ScaleWithAllTheirLengths) {
  ASSERT_EQ(one_of_each.size(), std::variant_size_v<SolidShape>);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(-8, 8);
  for (std::size_t i = 0; i < one_of_each.size(); ++i) {
    ASSERT_EQ(one_of_each[i].index(), i);
    const SolidShape larger =
        std::visit([](const auto& shape) -> SolidShape { return shape.scaled(4); }, one_of_each[i]);
    EXPECT_EQ(box_of(larger).low, 4 * box_of(one_of_each[i]).low);
    EXPECT_EQ(box_of(larger).high, 4 * box_of(one_of_each[i]).high);
    for (int n = 0; n < 1000; ++n) {
      const Vec3 p{place(random), place(random), place(random)};
      EXPECT_DOUBLE_EQ(distance_to(larger, 4 * p), 4 * distance_to(one_of_each[i], p)) << "shape " << i;
    }
  }
}

TEST(SizeShapes, AWakeScalesButForItsDirection) {
  const WakeShape wake{{}, Vec3{1, 2, 3}, Vec3{4, 5, 6}, {0, 2, 0}, 7, 0.5};
  const auto larger = std::get<WakeShape>(scaled(SizeShape(wake), 4));
  EXPECT_EQ(larger.from, (Vec3{4, 8, 12}));
  EXPECT_EQ(larger.to, (Vec3{16, 20, 24}));
  EXPECT_EQ(larger.direction, wake.direction);
  EXPECT_EQ(larger.length, 28);
  EXPECT_EQ(larger.end_size, 2);
  EXPECT_EQ((WakeShape{{"wing"}, {}, {}, {1, 0, 0}, 1, {}}).scaled(4).end_size, std::nullopt);
}

}  // namespace
}  // namespace aeroloom::sizing
