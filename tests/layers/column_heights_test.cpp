#include "layers/column_heights.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

WallLayers wall_layers(double first, double growth, std::int32_t constant) {
  WallLayers wanted;
  wanted.first = first, wanted.growth = growth, wanted.constant = constant;
  return wanted;
}

TEST(ColumnHeightsLocal, AreConstantThenGrow) {
  const Heights heights{0.5, 2, 3};
  std::vector<double> nodes;
  heights.for_each_node(5, [&](std::int32_t, double h) { nodes.push_back(h); });
  EXPECT_EQ(nodes, (std::vector<double>{0.5, 1, 1.5, 2.5, 4.5}));
  EXPECT_EQ(heights.total(5), 4.5);
  EXPECT_EQ(heights.total(0), 0);
}

TEST(ColumnHeightsLocal, EndWhereLayersAreIsotropic) {
  const WallLayers wanted = wall_layers(1e-5, 1.2, 2);
  const std::int32_t count = wanted_count(wanted, 0.1);
  const double last = 1e-5 * std::pow(1.2, count - 2);
  EXPECT_GT(last, 0.07 / std::sqrt(1.2) * (1 - 1e-9));
  EXPECT_LT(last, 0.07 * std::sqrt(1.2) * (1 + 1e-9));
  EXPECT_EQ(wanted_count(wall_layers(0.2, 1.2, 2), 0.1), 1) << "the first is more than that";
  EXPECT_EQ(wanted_count(wall_layers(0.05, 1.2, 1), 0.1), 3);
}

TEST(ColumnHeightsLocal, EndAtACountOrATotal) {
  WallLayers wanted = wall_layers(1, 2, 1);
  wanted.count = 4;
  EXPECT_EQ(wanted_count(wanted, 1000), 4);
  wanted.total = 7.5;
  EXPECT_EQ(wanted_count(wanted, 1000), 3) << "1 + 2 + 4";
  wanted.total = 0.1;
  EXPECT_EQ(wanted_count(wanted, 1000), 1);
  wanted = wall_layers(1, 1, 1);
  wanted.count = 12;
  EXPECT_EQ(wanted_count(wanted, 1), 12) << "without growth the count alone ends them";
}

TEST(ColumnHeightsLocal, CompressionKeepsTheCountThenDropsLayers) {
  const Heights heights{1, 1.5, 2};
  const double total = heights.total(10);
  const Compressed free = compress(heights, 10, total);
  EXPECT_EQ(free.count, 10);
  EXPECT_EQ(free.growth, 1.5);
  const Compressed tight = compress(heights, 10, 20);
  EXPECT_EQ(tight.count, 10);
  EXPECT_LE((Heights{1, tight.growth, 2}.total(10)), 20);
  EXPECT_NEAR((Heights{1, tight.growth, 2}.total(10)), 20, 1e-6);
  const Compressed few = compress(heights, 10, 6.5);
  EXPECT_EQ(few.count, 6);
  EXPECT_EQ(few.growth, 1);
  EXPECT_EQ(compress(heights, 10, 0.5).count, 0);
}

}  // namespace
}  // namespace aeroloom::layers
