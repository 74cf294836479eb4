/// Statistics of the layers by patch.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// By patch index of the mesh. Cells are counted for the given kind of elements. Sums run in the order of
/// pieces. Collective; equal on all ranks and for any number of ranks.
std::vector<PatchLayers> report_patches(const LocalWall& wall, const ColumnLimits& limits,
                                        LayerElements elements);

}  // namespace aeroloom::layers
