#include "sizing/choice/levels.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;

namespace {

/// The error of figures that guidelines give with two or three digits.
constexpr double rounded = 0.02;

void expect_near(double value, double expected) {
  EXPECT_NEAR(value / expected, 1, rounded) << value << " instead of " << expected;
}

}  // namespace

TEST(Levels, LettersAreThoseOfHighLift) {
  const std::array<double, 6> edge{0.225, 0.15, 0.1, 0.075, 0.05, 0.033};
  const std::array<double, 6> body{2.25, 1.5, 1, 0.75, 0.5, 0.33};
  const std::array<double, 6> growth{1.31, 1.2, 1.13, 1.095, 1.06, 1.04};
  const std::array<int, 6> cells{4, 6, 9, 12, 18, 27};
  const auto letters = levels_like(Level::c);
  ASSERT_EQ(letters.size(), 6);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const LevelSizes sizes = sizes_of(letters[i]);
    expect_near(100 * sizes.edge, edge[i]);
    expect_near(100 * sizes.span, edge[i]);
    expect_near(100 * sizes.body, body[i]);
    expect_near(sizes.growth, growth[i]);
    EXPECT_EQ(sizes.trailing_cells, cells[i]);
    EXPECT_EQ(sizes.far_field, 100);
    expect_near(layers_of(letters[i]).y_plus, body[i]);
  }
}

TEST(Levels, WordsAreThoseOfTheirFamily) {
  const std::array<double, 4> hlpw{0.15, 0.1, 0.067, 0.044}, dpw{0.1333, 0.1, 0.08, 0.0667};
  const std::array<int, 4> least_cells{4, 8, 12, 16};
  const auto words = levels_like(Level::coarse);
  ASSERT_EQ(words.size(), 4);
  for (std::size_t i = 0; i < words.size(); ++i) {
    expect_near(100 * sizes_of(words[i], LevelFamily::hlpw).edge, hlpw[i]);
    expect_near(100 * sizes_of(words[i], LevelFamily::dpw).edge, dpw[i]);
    EXPECT_GE(sizes_of(words[i]).trailing_cells, least_cells[i]);
  }
  EXPECT_GT(sizes_of(Level::medium, LevelFamily::dpw).trailing_cells, 8);
  for (int count = 2; count <= 5; ++count) {
    const LevelLayers layers = layers_of(words[static_cast<std::size_t>(count) - 2], LevelFamily::dpw);
    EXPECT_EQ(layers.constant_layers, count + 1);
    EXPECT_NEAR(layers.growth, std::pow(1.16, 1 / std::pow(1.5, count - 1)), 5e-4);
    EXPECT_NEAR(layers.y_plus, 2.0 / (count + 1), 5e-3);
  }
}

TEST(Levels, SizesAndLogarithmOfGrowthScaleByOneFactor) {
  for (const auto& [first, family] :
       {std::pair(Level::b, LevelFamily::hlpw), std::pair(Level::coarse, LevelFamily::hlpw),
        std::pair(Level::coarse, LevelFamily::dpw)}) {
    const LevelSizes base = sizes_of(first, family);
    EXPECT_DOUBLE_EQ(base.factor, 1);
    EXPECT_DOUBLE_EQ(base.growth, 1.2);
    for (const Level level : levels_like(first)) {
      const LevelSizes sizes = sizes_of(level, family);
      EXPECT_DOUBLE_EQ(sizes.edge, sizes.factor * base.edge);
      EXPECT_DOUBLE_EQ(sizes.span, sizes.factor * base.span);
      EXPECT_DOUBLE_EQ(sizes.body, sizes.factor * base.body);
      EXPECT_NEAR(std::log(sizes.growth), sizes.factor * std::log(base.growth), 1e-12);
      EXPECT_EQ(sizes.trailing_cells, std::ceil(base.trailing_cells / sizes.factor - rounded));
    }
  }
}

TEST(Levels, CellsAreFartherApart) {
  const LevelSizes vertex = sizes_of(Level::b), cell = sizes_of(Level::b, {}, SolverPoints::cell);
  EXPECT_DOUBLE_EQ(cell.edge, std::numbers::sqrt2 * vertex.edge);
  EXPECT_DOUBLE_EQ(cell.body, std::numbers::sqrt2 * vertex.body);
  EXPECT_EQ(cell.growth, vertex.growth);
  EXPECT_EQ(cell.trailing_cells, vertex.trailing_cells);
}

TEST(Levels, LettersAreNoneOfDragPrediction) {
  EXPECT_THROW(sizes_of(Level::a, LevelFamily::dpw), std::invalid_argument);
}
