#include "layers/layer_validity.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Equilateral, of edge 1, with `count` layers of `height` straight up.
TriangleColumns upright(double height, std::int32_t count) {
  TriangleColumns columns;
  const Vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  for (int i = 0; i < 3; ++i) columns[i] = {corners[i], {0, 0, 1}, {height, 1, 1}, count};
  return columns;
}

TEST(GoodLayersLocal, AreAllOfAnUprightColumn) {
  EXPECT_EQ(good_layers(upright(0.1, 7)), 7);
  EXPECT_EQ(good_layers(upright(1e-9, 7)), 7);
  EXPECT_EQ(good_layers(upright(0.1, 0)), 0);
}

TEST(GoodLayersLocal, EndWhereColumnsCross) {
  TriangleColumns columns = upright(0.1, 20);
  // Leans by 45 degrees towards the middle of the opposite side, so the prism is flat at a height of 0.87.
  columns[2].direction = normalized(Vec3{0, -1, 1});
  const std::int32_t good = good_layers(columns);
  EXPECT_GT(good, 2);
  EXPECT_LT(good, 10) << "0.87 / (0.1 sqrt(0.5)) = 12, and the Jacobian falls to half before";
}

TEST(GoodLayersLocal, AreBadOnTheWrongSideOfTheWall) {
  TriangleColumns columns = upright(0.1, 3);
  for (CornerColumn& column : columns) column.direction = {0, 0, -1};
  EXPECT_EQ(good_layers(columns), 0);
  columns[1].count = columns[2].count = 0;
  EXPECT_EQ(good_layers(columns), 0) << "tetrahedra";
  columns[1].count = 3;
  EXPECT_EQ(good_layers(columns), 0) << "pyramids";
}

TEST(GoodLayersLocal, CountTheCellsOfClippedColumns) {
  for (int alone = 0; alone < 3; ++alone) {
    TriangleColumns columns = upright(0.1, 5);
    columns[alone].count = 2;
    EXPECT_EQ(good_layers(columns), 5) << "pyramids on prisms";
    columns[(alone + 1) % 3].count = 4;
    EXPECT_EQ(good_layers(columns), 5) << "and a tetrahedron";
  }
}

TEST(FittingHeightLocal, KeepsTheAngleOfTheCap) {
  TriangleColumns columns = upright(0.1, 30);
  columns[0].count = columns[1].count = 3;
  // Sides of the cap: 1, and the root of 1 + h^2 twice; its least angle falls below 36 degrees at h = 1.28.
  EXPECT_EQ(good_layers(columns), 30);
  EXPECT_FALSE(has_good_cap(columns));
  double height = fitting_height(columns);
  EXPECT_GE(height, 0.8 * 3.0 - 0.05 * 3.0) << "not lower at once: columns may be fitted in another way";
  while (height < 10) {
    columns[2].count = static_cast<std::int32_t>(height / 0.1);
    const double lower = fitting_height(columns);
    ASSERT_TRUE(lower < height || lower > 10);
    height = lower;
  }
  EXPECT_LE(columns[2].count, 15);
  EXPECT_GE(columns[2].count, 14);
  EXPECT_TRUE(has_good_cap(columns));
  columns[2].count = 14;
  EXPECT_TRUE(has_good_cap(columns));
  EXPECT_EQ(fitting_height(columns), std::numeric_limits<double>::infinity());
}

TEST(FittingHeightLocal, EndsBelowTheFirstBadLayer) {
  TriangleColumns columns = upright(0.1, 20);
  columns[2].direction = normalized(Vec3{0, -1, 1});
  double height = fitting_height(columns);
  EXPECT_LT(height, 2.0);
  for (CornerColumn& column : columns) column.count = static_cast<std::int32_t>(height / 0.1);
  while ((height = fitting_height(columns)) < 10) {
    const std::int32_t count = columns[0].count;
    for (CornerColumn& column : columns) column.count = static_cast<std::int32_t>(height / 0.1);
    ASSERT_LT(columns[0].count, count);
  }
  EXPECT_GT(columns[0].count, 2);
  EXPECT_EQ(good_layers(columns), columns[0].count);
  EXPECT_TRUE(has_good_cap(columns));
}

TEST(FittingHeightLocal, IsZeroWhereNoLayerIsGood) {
  TriangleColumns columns = upright(0.1, 3);
  for (CornerColumn& column : columns) column.direction = normalized(Vec3{1, 1, -0.5});
  for (int calls = 0; columns[0].count > 0; ++calls) {
    ASSERT_LT(calls, 10);
    const double height = fitting_height(columns);
    for (CornerColumn& column : columns) column.count = static_cast<std::int32_t>(height / 0.1);
  }
}

/// A sector along the x axis between columns at these angles, in degrees, at both its ends.
FanColumns sector(std::array<double, 2> first, std::array<double, 2> second) {
  FanColumns fan{{true, {1, 1}}, {}};
  const auto column = [](double x, double angle) {
    const double radians = angle * std::numbers::pi / 180;
    return CornerColumn{{x, 0, 0}, {0, std::cos(radians), std::sin(radians)}, {1e-4, 1, 1}, 1};
  };
  fan.columns = {column(0, first[0]), column(0, first[1]), column(1, second[1]), column(1, second[0])};
  return fan;
}

TEST(FanColumnsLocal, AreBadWhereTheFirstLayerIsTwisted) {
  EXPECT_TRUE(has_good_first_layer(sector({0, 30}, {0, 30})));
  EXPECT_TRUE(has_good_first_layer(sector({0, 30}, {20, 50})));
  EXPECT_FALSE(has_good_first_layer(sector({0, 30}, {35, 65})));
  EXPECT_TRUE(has_good_first_layer(sector({0, 60}, {35, 95})));
  EXPECT_FALSE(has_good_first_layer(sector({0, 165}, {30, 195}))) << "a flat triangle";
}

}  // namespace
}  // namespace aeroloom::layers
