/// The columns of a wall and what limits them: each limit is a minimum, iterated over all pieces to its fixed
/// point, so no order decides.
#pragma once

#include "layers/column_heights.hpp"
#include "layers/directions.hpp"
#include "layers/local_wall.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// Columns on the vertices of a wall, equal in all pieces that know a vertex. Counts, growth and limits only
/// ever fall, and with them every node's height.
class ColumnLimits {
public:
  /// The columns that the patches ask for. Collective.
  ColumnLimits(const LocalWall& wall, const LayerOptions& options, const VertexStars& stars,
               const Directions& directions);

  Heights heights(std::int32_t v) const { return {_first[v], _growth[v], _constant[v]}; }
  std::int32_t count(std::int32_t v) const { return _counts[v]; }
  std::int32_t wanted_count(std::int32_t v) const { return _wanted_counts[v]; }
  double total(std::int32_t v) const { return heights(v).total(_counts[v]); }
  double last_height(std::int32_t v) const { return heights(v).last(_counts[v]); }
  bool is_compressed(std::int32_t v) const { return _growth[v] < _wanted_growth[v]; }
  LayerLimit cause(std::int32_t v) const { return _causes[v]; }
  double mean_edge(std::int32_t v) const { return _mean_edges[v]; }

  /// No column of the vertices is higher than `limits` from now on; larger values change nothing. `limits`
  /// need not be equal in all pieces: the smallest counts. Collective.
  void limit_totals(std::vector<double> limits, LayerLimit cause);
  /// No column has more layers; as limit_totals. Growth stays. Collective.
  void limit_counts(std::vector<std::int32_t> counts, LayerLimit cause);
  /// Lets neighbours follow: counts within `stairs`, totals within the slope, until nothing changes.
  /// Collective.
  void converge();

  /// The vertices whose columns changed since the last call; equal in all pieces.
  std::vector<std::int32_t> take_changed();

private:
  void note_change(std::int32_t v, LayerLimit cause);
  /// Brings count and growth of a column within its limit.
  void fit(std::int32_t v, LayerLimit cause);
  void cut_count(std::int32_t v, std::int32_t count, LayerLimit cause);
  /// Lowers `values`, one a vertex, to their greatest fixed point: `follow(v, u, value of v)` is the most
  /// that the neighbour u may have. `from` are the vertices whose values are below what they were.
  /// Collective.
  template <class T, class Follow>
  void propagate(std::vector<T>& values, std::vector<std::int32_t> from, const Follow& follow) const;
  void converge_counts();
  void converge_totals();

  const LocalWall& _wall;
  std::int32_t _stairs;
  std::vector<double> _first, _growth, _wanted_growth, _mean_edges, _slopes;
  std::vector<double> _limits;  ///< of the totals: what neighbours go by
  std::vector<std::int32_t> _constant, _counts, _wanted_counts;
  std::vector<LayerLimit> _causes;
  std::vector<std::uint8_t> _changed;
  std::vector<std::int32_t> _changed_vertices;             ///< since the last take_changed()
  std::vector<std::int32_t> _lower_counts, _lower_totals;  ///< since neighbours followed last
};

}  // namespace aeroloom::layers
