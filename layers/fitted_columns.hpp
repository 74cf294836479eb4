/// Columns within all limits but the cap's, with fans whose sectors fit them.
#pragma once

#include "layers/column_limits.hpp"
#include "layers/directions.hpp"
#include "layers/fans.hpp"

#include <vector>

namespace aeroloom::layers {

/// Columns as limits leave them.
struct FittedColumns {
  Fans fans;
  Directions directions;
  ColumnLimits limits;
  int rounds = 0;  ///< until all cells were good
};

/// What columns follow from.
struct LayerInput {
  const LocalWall& wall;
  const VertexStars& stars;
  const std::vector<VertexLayers>& wanted;
  const std::vector<FittedLayers>& fitted;  ///< fit_wanted_layers()
  const std::vector<double>& edges;         ///< smooth_mean_edges()
  bool may_have_fans, bends_columns;
};

/// Columns with fans whose sectors fit the heights that are reached, fewer along ridges on which the first
/// layer would be invalid; one column at vertices where fans would be low, and at all where most fans would
/// have no layers. Collective.
FittedColumns fit_columns(const LayerInput& in);

}  // namespace aeroloom::layers
