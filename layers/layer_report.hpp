/// Statistics of the layers by patch.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// By patch index of the mesh. Cells are counted for the kind of elements in `options`. Sums run in the order
/// of pieces. Collective; equal on all ranks and for any number of ranks.
std::vector<PatchLayers> report_patches(const LocalWall& wall, const Fans& fans, const Directions& directions,
                                        const ColumnLimits& limits, const LayerOptions& options);

/// Adds the figures of a part of a patch to those of the others.
void add_figures(const PatchLayers& part, PatchLayers& sum);

}  // namespace aeroloom::layers
