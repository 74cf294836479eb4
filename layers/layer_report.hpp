/// The table of layers by patch.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// By patch index of the mesh, with the cells that there are of such elements; sums in the order of pieces.
/// Collective, the same on every rank and for any number of ranks.
std::vector<PatchLayers> report_patches(const LocalWall& wall, const ColumnLimits& limits,
                                        LayerElements elements);

}  // namespace aeroloom::layers
