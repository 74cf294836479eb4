/// The shell in a rank's blocks: its points, and the border of the core, behind which a table tells the
/// tetrahedra.
#pragma once

#include "volume/core/core_cells.hpp"
#include "volume/core/core_squares.hpp"

#include <cstdint>
#include <memory>
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

/// The shell and the core in this rank's blocks. Immutable: where retries change points, another one is made.
struct LocalShell {
  std::vector<BlockChange> changes;  ///< per block: what the points are made with
  CoreSquares squares;
  CoreLeaves core;
  std::int64_t lattice_points = 0;  ///< with those of the core
  BlockPoints points;               ///< those of the shell
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

/// Makes the points of this rank's blocks, and tells core from shell. `surface` has the triangles within the
/// search radii, and is let go once there are points. Collective.
LocalShell make_local_shell(const Lattice& lattice, std::unique_ptr<const NearSurface> surface,
                            std::vector<BlockChange> changes);

}  // namespace aeroloom::volume
