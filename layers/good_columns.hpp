/// Shrinks columns until all cells between wall and layer cap are good.
#pragma once

#include "layers/column_limits.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// What was judged when columns were shrunk, round by round. Where columns are built again and a few differ
/// from the start, most of the others go through the same rounds.
struct JudgedColumns {
  struct State {
    FittedLayers fitted;
    std::int32_t since;   ///< round
    std::int32_t before;  ///< the state that it replaced; -1: none
  };
  struct Verdict {
    double height;  ///< fitting_height()
    std::int32_t round;
    std::int32_t before;  ///< that of an earlier round; -1: none
  };
  std::vector<std::array<std::int32_t, 3>> corners;      ///< by triangle: Fans::columns
  std::vector<geometry::Vec3> directions;                ///< by column
  std::vector<Heights> heights;                          ///< by vertex, without what is fitted
  std::vector<std::int32_t> last_states, last_verdicts;  ///< by vertex, by triangle; -1: none
  std::vector<State> states;
  std::vector<Verdict> verdicts;
};

/// Bounds column heights by fitting_height(), then lowers neighbours, and repeats until all cells are good.
/// Checks only triangles whose columns changed since the last call. Where `judged` is empty it gets what is
/// judged; else what is known from there is not judged again. Returns the number of rounds, equal on all
/// ranks. Collective.
int shrink_to_good(const LocalWall& wall, const Fans& fans, const Directions& directions,
                   ColumnLimits& limits, JudgedColumns* judged = nullptr);

}  // namespace aeroloom::layers
