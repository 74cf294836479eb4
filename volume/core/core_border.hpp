/// The points of the shell and the border of the core, which zones are given where there is a core.
#pragma once

#include "volume/core/core_cells.hpp"

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// The border triangles beside core leaves of consecutive blocks.
struct BlockBorders {
  BlockIndex first = 0;
  std::vector<std::int64_t> starts;  ///< blocks + 1
  std::vector<BorderTriangle> triangles;

  std::span<const BorderTriangle> of(BlockIndex b) const {
    return std::span(triangles).subspan(starts[b - first], starts[b - first + 1] - starts[b - first]);
  }
};

/// The shell and the core in this rank's blocks.
struct ShellShare {
  BlockPoints points;  ///< those of the shell
  BlockBorders borders;
  std::vector<std::uint8_t> deep;  ///< per block: core leaves without points of the shell, a bit each
  /// Per block: cells of the core without points of the shell, and those with some.
  std::vector<std::uint16_t> inner_cells, border_cells;

  /// About, since cells in the midst of the core are not counted one by one.
  std::int64_t core_cells() const {
    return std::accumulate(inner_cells.begin(), inner_cells.end(), std::int64_t{0}) +
           std::accumulate(border_cells.begin(), border_cells.end(), std::int64_t{0});
  }
};

/// `points` are all those of this rank's blocks.
ShellShare find_shell(const LatticeTree& tree, const CoreLeaves& core, const CoreSquares& squares,
                      BlockPoints points);

}  // namespace aeroloom::volume
