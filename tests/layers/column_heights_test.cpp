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

TEST(ColumnHeightsLocal, LoseTheirLastLayersAboveALimit) {
  const Heights heights{0.5, 2, 3};  // ends at 0.5, 1, 1.5, 2.5, 4.5
  EXPECT_EQ(layers_below(heights, 5, 10), 5);
  EXPECT_EQ(layers_below(heights, 5, 4.5), 5) << "the limit itself is allowed";
  EXPECT_EQ(layers_below(heights, 5, 4.4), 4);
  EXPECT_EQ(layers_below(heights, 2, 4.4), 2);
  EXPECT_EQ(layers_below(heights, 5, 0.4), 0);
}

Heights fitted_heights(const Heights& heights, const FittedLayers& fitted) {
  return {heights.first, heights.growth, heights.constant, fitted.regular, fitted.stretch};
}

/// The last of layers that grow regularly to this height.
double regular_last(const Heights& heights, double total) {
  return heights.first + (total - heights.constant * heights.first) * (heights.growth - 1) / heights.growth;
}

TEST(ColumnHeightsLocal, GrowUpToALimit) {
  const Heights heights{1e-5, 1.2, 2};
  for (double limit = 2e-4; limit < heights.total(60); limit *= 1.07) {
    for (const double aim : {1.0, 2.0, 1e3}) {
      const FittedLayers fitted = fit_layers(heights, 60, limit, aim * regular_last(heights, limit));
      const Heights grown = fitted_heights(heights, fitted);
      EXPECT_NEAR(grown.total(fitted.count), limit, 1e-12 * limit);
      EXPECT_EQ(fitted.count % 4, 0) << "neighbours have as many";
      EXPECT_EQ(fitted.regular, fitted.count - 5);
      EXPECT_GT(1.2 * fitted.stretch, 1 - 1e-9);
      EXPECT_LT(1.2 * fitted.stretch, 1.5 + 1e-9);
      EXPECT_EQ(grown.total(fitted.regular), heights.total(fitted.regular)) << "the others stay";
      EXPECT_NEAR(grown.last(fitted.count), grown.total(fitted.count) - grown.total(fitted.count - 1),
                  1e-12 * limit);
    }
  }
  const FittedLayers allowed = fit_layers(heights, 59, heights.total(59), heights.last(59));
  EXPECT_EQ(allowed.count, 59) << "as many as allowed, too";
  EXPECT_NEAR(allowed.stretch, 1, 1e-14);
}

TEST(ColumnHeightsLocal, AimAtALastLayer) {
  const Heights heights{1e-5, 1.2, 2};
  const double limit = heights.total(40) / 1.3, last = regular_last(heights, limit);
  std::int32_t count = 40;
  for (double aim = last / 2; aim < 3 * last; aim *= 1.1) {
    const FittedLayers fitted = fit_layers(heights, 60, limit, aim);
    EXPECT_LE(fitted.count, count) << "fewer and thicker ones";
    count = fitted.count;
  }
  EXPECT_EQ(fit_layers(heights, 60, limit, last / 2).count, 40);
  const FittedLayers fewest = fit_layers(heights, 60, limit, 3 * last);
  EXPECT_EQ(fewest.count, 36);
  EXPECT_GT(fitted_heights(heights, fewest).last(36), 1.5 * last) << "of the same height together";
}

TEST(ColumnHeightsLocal, TakeStepsOfAboutAFactorOfTwo) {
  EXPECT_EQ(layers_in_a_step(1), 8) << "at most";
  EXPECT_EQ(layers_in_a_step(1 + 1e-15), 8);
  EXPECT_EQ(layers_in_a_step(1.1), 7);
  EXPECT_EQ(layers_in_a_step(1.2), 4);
  EXPECT_EQ(layers_in_a_step(1.3), 3);
  EXPECT_EQ(layers_in_a_step(1.5), 2);
  EXPECT_EQ(layers_in_a_step(2), 1);
  EXPECT_EQ(layers_in_a_step(10), 1);
  for (const double growth : {1.1, 1.15, 1.3, 1.5, 2.0, 3.0}) {
    const Heights heights{1e-5, growth, 2};
    const std::int32_t step = layers_in_a_step(growth);
    for (double limit = heights.total(3 * step + 2); limit < heights.total(50); limit *= 1.07) {
      const FittedLayers fitted = fit_layers(heights, 60, limit, regular_last(heights, limit));
      const Heights grown = fitted_heights(heights, fitted);
      EXPECT_NEAR(grown.total(fitted.count), limit, 1e-12 * limit);
      EXPECT_EQ(fitted.count % step, 0) << growth;
      EXPECT_EQ(fitted.regular, fitted.count - step - 1);
      EXPECT_GT(grown.last(fitted.count), 0.5 * regular_last(heights, limit)) << growth << ", " << limit;
    }
  }
}

TEST(ColumnHeightsLocal, StretchTheLastOfFewLayers) {
  const Heights heights{0.5, 1.25, 3};  // ends at 0.5, 1, 1.5, 2.125
  EXPECT_EQ(fit_layers(heights, 4, 2, 1), (FittedLayers{3, 2, 2})) << "steps of three, four to stretch";
  EXPECT_EQ(fit_layers(heights, 2, 1, 1), (FittedLayers{2, 1, 1}));
  EXPECT_EQ(fit_layers(heights, 4, 0.7, 1), FittedLayers{1}) << "the first layer keeps its height";
  EXPECT_EQ(fit_layers(heights, 4, 0.4, 1).count, 0);
}

TEST(ColumnHeightsLocal, EndWherePatchesAsk) {
  WallLayers wanted = wall_layers(1e-5, 1.2, 2);
  for (double edge = 0.05; edge < 0.2; edge *= 1.01) {
    const FittedLayers fitted = wanted_layers(wanted, edge);
    EXPECT_NEAR(fitted.count, wanted_count(wanted, edge), 3);
    const Heights heights = fitted_heights({1e-5, 1.2, 2}, fitted);
    const double to_isotropic = 2e-5 + 6 * (isotropic_height * edge - 1e-5);
    EXPECT_NEAR(heights.total(fitted.count), to_isotropic, 1e-9) << "a steady function of the edge";
    EXPECT_GT(heights.last(fitted.count), smooth_end * edge);
  }
  wanted.total = 0.01;
  EXPECT_NEAR(
      fitted_heights({1e-5, 1.2, 2}, wanted_layers(wanted, 0.1)).total(wanted_layers(wanted, 0.1).count),
      0.01, 1e-14);
  wanted.total = 1e-6;
  EXPECT_EQ(wanted_layers(wanted, 0.1), FittedLayers{1}) << "at least one";
  wanted.total = 0, wanted.count = 30;
  EXPECT_EQ(wanted_layers(wanted, 0.1), FittedLayers{30}) << "not stretched";
  wanted = wall_layers(1, 1, 1);
  wanted.count = 12;
  EXPECT_EQ(wanted_layers(wanted, 1), FittedLayers{12});
}

TEST(ColumnHeightsLocal, GrowAsATotalAsks) {
  const Heights steepest{1, 1.5, 2};
  EXPECT_EQ(growth_of_total(steepest, 10, steepest.total(10)), 1.5);
  EXPECT_EQ(growth_of_total(steepest, 10, 1e9), 1.5) << "at most";
  const double growth = growth_of_total(steepest, 10, 20);
  EXPECT_NEAR((Heights{1, growth, 2}.total(10)), 20, 1e-6);
  EXPECT_EQ(growth_of_total(steepest, 10, 5), 1) << "no total of ten layers is as low";
}

TEST(ColumnHeightsLocal, HaveRoomInAGap) {
  EXPECT_DOUBLE_EQ(room_in_gap(10, 1, 1), 4) << "no more than 0.4 of the gap";
  EXPECT_DOUBLE_EQ(room_in_gap(2, 1, 1), 0.5) << "a tetrahedron fits between";
  EXPECT_DOUBLE_EQ(room_in_gap(1, 1, 1), 0.25) << "thin layers below large tetrahedra are worse";
  EXPECT_DOUBLE_EQ(room_in_gap(0.1, 1, 1), 0.025);
  EXPECT_DOUBLE_EQ(room_in_gap(1, 1, 0.8), 0.25 / 0.8) << "a column in a corner leans to both walls";
  EXPECT_DOUBLE_EQ(room_in_gap(1, 1, 0.1), 0.4);
}

}  // namespace
}  // namespace aeroloom::layers
