#include "sizing/choice/levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

/// A row of the guidelines.
struct Row {
  Level level;
  double edge;  ///< percent of the local chord; of the semispan as well
  int trailing_cells;
  LevelLayers layers;
};

constexpr std::array<Row, 6> letters{{
    {Level::a, 0.225, 4, {2.25, 1.25, 0}},
    {Level::b, 0.15, 6, {1.5, 1.16, 0}},
    {Level::c, 0.1, 9, {1.0, 1.10, 0}},
    {Level::d, 0.075, 12, {0.75, 1.07, 0}},
    {Level::e, 0.05, 18, {0.5, 1.05, 0}},
    {Level::f, 0.1 / 3, 27, {1.0 / 3, 1.03, 0}},
}};

// HLPW-3 has 4, 8, 12, 16 cells at least: these are as many, and scale as sizes do.
constexpr std::array<Row, 4> hlpw_words{{
    {Level::coarse, 0.15, 6, {1.0, 1.25, 2}},
    {Level::medium, 0.1, 9, {0.67, 1.16, 2}},
    {Level::fine, 0.2 / 3, 14, {0.44, 1.10, 2}},
    {Level::extra, 0.4 / 9, 21, {0.30, 1.07, 2}},
}};

// Sizes go with 2 / (L + 1), L = 2 to 5. DPW-8 wants well above 8 cells at the medium level: 12.
constexpr std::array<Row, 4> dpw_words{{
    {Level::coarse, 0.4 / 3, 9, {0.67, 1.104, 3}},
    {Level::medium, 0.1, 12, {0.5, 1.068, 4}},
    {Level::fine, 0.08, 15, {0.4, 1.045, 5}},
    {Level::extra, 0.2 / 3, 18, {0.33, 1.030, 6}},
}};

constexpr std::array<Level, 6> all_letters{Level::a, Level::b, Level::c, Level::d, Level::e, Level::f};
constexpr std::array<Level, 4> all_words{Level::coarse, Level::medium, Level::fine, Level::extra};

/// Of walls over that of edges, in every guideline.
constexpr double body_over_edge = 10;
constexpr double first_growth = 1.2;  // of B and of coarse
/// Of B and of coarse; less would only tell at noses of bodies and in fillets. Chosen, not measured.
constexpr double first_curvature_angle = 12, largest_curvature_angle = 30;
constexpr double far_field_in_semispans = 100;
/// HLPW-4 has wakes of two chords, HLPW-3 of one or more; DPW says nothing of them.
constexpr double letters_wake = 2, words_wake = 1;

bool is_letter(Level level) {
  return level < Level::coarse;
}

std::span<const Row> rows_of(Level level, std::optional<LevelFamily> family) {
  if (family == LevelFamily::dpw) {
    if (is_letter(level))
      throw std::invalid_argument(fmt::format(
          "sizing.level: {} is a level of the family hlpw; dpw has coarse, medium, fine and extra",
          name_of(level)));
    return dpw_words;
  }
  if (is_letter(level)) return letters;
  return hlpw_words;
}

const Row& row_of(Level level, std::optional<LevelFamily> family) {
  const std::span<const Row> rows = rows_of(level, family);
  return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.level == level; });
}

}  // namespace

const char* name_of(Level level) {
  constexpr std::array<const char*, 10> names{"A", "B",      "C",      "D",    "E",
                                              "F", "coarse", "medium", "fine", "extra"};
  return names[static_cast<std::size_t>(level)];
}

const char* name_of(LevelFamily family) {
  return family == LevelFamily::dpw ? "dpw" : "hlpw";
}

std::span<const Level> levels_like(Level level) {
  if (is_letter(level)) return all_letters;
  return all_words;
}

LevelSizes sizes_of(Level level, std::optional<LevelFamily> family, SolverPoints points) {
  const Row& row = row_of(level, family);
  const double first = row_of(is_letter(level) ? Level::b : Level::coarse, family).edge;
  const double spread = points == SolverPoints::cell ? std::numbers::sqrt2 : 1;
  LevelSizes sizes;
  sizes.factor = row.edge / first;
  sizes.edge = sizes.span = spread * row.edge / 100;
  sizes.body = body_over_edge * sizes.edge;
  sizes.trailing_cells = row.trailing_cells;
  sizes.growth = std::pow(first_growth, sizes.factor);
  sizes.far_field = far_field_in_semispans;
  sizes.wake = is_letter(level) ? letters_wake : words_wake;
  sizes.curvature_angle = std::min(largest_curvature_angle, spread * sizes.factor * first_curvature_angle);
  return sizes;
}

LevelLayers layers_of(Level level, std::optional<LevelFamily> family) {
  return row_of(level, family).layers;
}

}  // namespace aeroloom::sizing
