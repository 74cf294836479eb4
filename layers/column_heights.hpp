/// The heights of one column.
#pragma once

#include "layers/columns.hpp"

#include <cstdint>

namespace aeroloom::layers {

/// Layers of a column: `constant` of height `first`, then each `growth` times the one before.
struct Heights {
  double first = 0, growth = 1;
  std::int32_t constant = 1;

  /// Calls visit(k, height of node k) for k = 1 ... count. The sum that layers are placed by.
  template <class Visit>
  void for_each_node(std::int32_t count, const Visit& visit) const {
    double layer = first, sum = 0;
    for (std::int32_t k = 1; k <= count; ++k) {
      if (k > constant) layer *= growth;
      sum += layer;
      visit(k, sum);
    }
  }
  double total(std::int32_t count) const {
    double height = 0;
    for_each_node(count, [&](std::int32_t, double h) { height = h; });
    return height;
  }
  /// Of the last of `count` layers; of none, 0.
  double last(std::int32_t count) const {
    double layer = count > 0 ? first : 0;
    for (std::int32_t k = constant + 1; k <= count; ++k) layer *= growth;
    return layer;
  }
};

/// No column has more layers.
inline constexpr std::int32_t most_layers = 1000;

/// As many layers as it takes until the last is about 0.7 of the mean edge, as `wanted` allows, at least one.
std::int32_t wanted_count(const WallLayers& wanted, double mean_edge);

/// A column within a limit.
struct Compressed {
  double growth = 1;
  std::int32_t count = 0;
};
/// Growth falls until `count` layers are no higher than `limit` together. Where they are at a growth of 1,
/// there are fewer of them.
Compressed compress(const Heights& heights, std::int32_t count, double limit);

/// A gap in which layers of this total have all the room they want, beside edges of this length.
double ample_gap(double total, double mean_edge);
/// The total that layers may have in a gap: 0.4 of it, and no more than half of what it leaves beside an
/// edge, for a tetrahedron; but all layers of the first height, `all_first` together, are kept where 0.4 of
/// the gap holds them.
double room_in_gap(double gap, double mean_edge, double all_first);

}  // namespace aeroloom::layers
