/// The shell in the blocks of a rank: its points, and its border with the core, whose tetrahedra come from a
/// table.
#pragma once

#include "volume/core/core_cells.hpp"
#include "volume/core/core_squares.hpp"

#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// The border triangles beside the core leaves of consecutive blocks.
struct BlockBorders {
  BlockIndex first = 0;
  std::vector<std::int64_t> starts;  ///< blocks + 1
  std::vector<BorderTriangle> triangles;

  std::span<const BorderTriangle> of(BlockIndex b) const {
    return std::span(triangles).subspan(starts[b - first], starts[b - first + 1] - starts[b - first]);
  }
};

/// Shell and core in the blocks of this rank. Immutable: retries that change points make a new one.
struct LocalShell {
  std::vector<BlockChange> changes;  ///< per block index, by retries so far
  CoreSquares squares;
  CoreLeaves core;
  std::int64_t lattice_points = 0;  ///< of shell and core
  BlockPoints points;               ///< of the shell
  BlockBorders borders;
  std::vector<std::uint8_t> deep;  ///< per own block: core leaves without shell points, as bits
  /// Per own block: core tetrahedra without points of the shell, and those with some.
  std::vector<std::uint16_t> inner_cells, border_cells;

  /// Approximate: tetrahedra deep in the core are not counted one by one.
  std::int64_t core_cells() const {
    return std::accumulate(inner_cells.begin(), inner_cells.end(), std::int64_t{0}) +
           std::accumulate(border_cells.begin(), border_cells.end(), std::int64_t{0});
  }
};

/// Makes the points of this rank's blocks, and divides them into core and shell. `surface` has the triangles
/// within the search radii; it is freed as soon as the points are made. Collective.
LocalShell make_local_shell(const Lattice& lattice, std::unique_ptr<const LocalSurface> surface,
                            std::vector<BlockChange> changes);

}  // namespace aeroloom::volume
