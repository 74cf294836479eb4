/// The columns of a wall and the limits on their heights. Every limit is a minimum and is iterated over all
/// pieces to its fixed point. So the order of evaluation does not change the result.
#pragma once

#include "layers/column_heights.hpp"
#include "layers/directions.hpp"
#include "layers/wanted_layers.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// The columns on the vertices of a wall. All pieces with a vertex have equal values for it. Limits and
/// counts only fall. A column above its limit loses its last layers, and those that are then the last
/// grow up to it (fit_layers).
class ColumnLimits {
public:
  /// Starts with the columns that the patches ask for. Keeps a reference to the wall. Collective.
  /// `fitted`: fit_wanted_layers().
  ColumnLimits(const LocalWall& wall, const std::vector<VertexLayers>& all_wanted,
               const std::vector<FittedLayers>& fitted, const VertexStars& stars,
               const Directions& directions);

  Heights heights(std::int32_t v) const {
    return {_first[v], _growth[v], _constant[v], _fitted[v].regular, _fitted[v].stretch};
  }
  /// Without stretch.
  Heights regular_heights(std::int32_t v) const { return {_first[v], _growth[v], _constant[v]}; }
  const FittedLayers& fitted(std::int32_t v) const { return _fitted[v]; }
  std::int32_t count(std::int32_t v) const { return _fitted[v].count; }
  std::int32_t wanted_count(std::int32_t v) const { return _wanted_counts[v]; }
  double total(std::int32_t v) const { return heights(v).total(count(v)); }
  double last_height(std::int32_t v) const { return heights(v).last(count(v)); }
  LayerLimit cause(std::int32_t v) const { return _causes[v]; }
  double mean_edge(std::int32_t v) const { return _mean_edges[v]; }

  /// Limits the total height of each column. Values above the present limit have no effect. Pieces may pass
  /// different values for one vertex; the smallest counts. Collective.
  void limit_totals(std::vector<double> limits, LayerLimit cause);
  /// Limits the number of layers of each column in the same way. Collective.
  void limit_counts(std::vector<std::int32_t> counts, LayerLimit cause);
  /// Lowers neighbours until totals along an edge differ by the allowed slope at most. Collective.
  void converge();

  /// The vertices whose columns changed since the last call; equal in all pieces.
  std::vector<std::int32_t> take_changed();

private:
  void note_change(std::int32_t v, LayerLimit cause);
  /// Fits the layers of a column below its limit.
  void fit(std::int32_t v, LayerLimit cause);
  void cut_count(std::int32_t v, std::int32_t count, LayerLimit cause);
  /// Lowers limits to the greatest that rise no faster than the slopes. `from` lists the vertices whose
  /// limits have fallen. Collective.
  void lower_by_slopes(std::vector<double>& limits, std::vector<std::int32_t> from) const;

  const LocalWall& _wall;
  std::vector<double> _first, _growth, _mean_edges, _slopes, _wanted_lasts;
  std::vector<double> _limits;  ///< of total heights; neighbours use these
  std::vector<std::int32_t> _constant, _wanted_counts;
  std::vector<FittedLayers> _fitted;
  std::vector<LayerLimit> _causes;
  std::vector<std::uint8_t> _changed;
  std::vector<std::int32_t> _changed_vertices;  ///< since the last take_changed()
  std::vector<std::int32_t> _lowered;           ///< since the last converge()
};

}  // namespace aeroloom::layers
