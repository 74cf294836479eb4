/// Cells of a fine surface: connected groups of its triangles, each a disk, from which the coarse boundary of
/// the background volume is made.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::partition {

struct CellOptions {
  double width = 14;    ///< of a cell, in local sizes, about
  double turning = 60;  ///< degrees the surface turns from one end of a cell to the other, about
};

/// A patch of a fine surface.
struct FinePatch {
  std::span<const geometry::Vec3> points;
  std::span<const std::array<std::int32_t, 3>> triangles;  ///< oriented alike
};

/// The cell of each triangle, numbered by first triangle. Cells are Voronoi cells of triangles spread evenly
/// in a metric of length and turning (Cohen-Steiner, Alliez, Desbrun, ACM Trans. Graph. 23, 2004,
/// doi:10.1145/1015706.1015817, whose relaxation recentres them). Deterministic.
std::vector<std::int32_t> grow_cells(const FinePatch& patch, const CellOptions& options);

/// Cuts the cells with `cut[cell]` in two, where they are longest; single triangles stay. The others keep
/// their triangles; all are numbered anew. Deterministic.
std::vector<std::int32_t> cut_cells(const FinePatch& patch, std::vector<std::int32_t> cells,
                                    const std::vector<char>& cut);

}  // namespace aeroloom::partition
