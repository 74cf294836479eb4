/// The table of layers by patch.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// By patch index of the mesh; sums in the order of pieces. Collective, the same on every rank and for any
/// number of ranks.
std::vector<PatchLayers> report_patches(const parallel::Communicator& communicator, const WallShare& wall,
                                        const ColumnLimits& limits);

}  // namespace aeroloom::layers
