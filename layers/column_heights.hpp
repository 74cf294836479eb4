/// The heights of the nodes in one column of boundary-layer nodes.
#pragma once

#include "layers/columns.hpp"

#include <cstdint>

namespace aeroloom::layers {

/// A geometric column: `constant` layers of height `first`, then each `growth` times the one below.
struct Heights {
  double first = 0, growth = 1;
  std::int32_t constant = 1;

  /// Calls visit(k, height of node k) for k = 1 ... count. All nodes are placed by this sum.
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
  /// Height of the last of `count` layers; 0 for count = 0.
  double last(std::int32_t count) const {
    double layer = count > 0 ? first : 0;
    for (std::int32_t k = constant + 1; k <= count; ++k) layer *= growth;
    return layer;
  }
};

/// The largest number of layers in a column.
inline constexpr std::int32_t most_layers = 1000;

/// Height over the mean edge of a prism that is about as good as a tetrahedron.
inline constexpr double isotropic_height = 0.7;

/// Least height of a last layer, over the mean edge, at which the step to the tetrahedra is still smooth:
/// half of what is aimed at.
inline constexpr double smooth_end = 0.5 * isotropic_height;

/// The number of layers of a column, at least 1, so that the last layer is about 0.7 of the mean edge length
/// at the vertex. Count and total height in `wanted` are upper bounds.
std::int32_t wanted_count(const WallLayers& wanted, double mean_edge);

/// The largest number of layers, at most `count`, that are together no higher than `limit`.
std::int32_t layers_below(const Heights& heights, std::int32_t count, double limit);

/// The growth, from 1 to that of `steepest`, by which `count` layers are as high as `total` together.
double growth_of_total(const Heights& steepest, std::int32_t count, double total);

/// The smallest gap that does not limit layers of this total height. `mean_edge`: mean edge length at the
/// vertex.
double ample_gap(double total, double mean_edge);
/// The total height allowed in a gap between two walls: (gap - mean_edge) / 2, which leaves room for a
/// tetrahedron, but at least 0.25 gap along the walls' normals and at most 0.4 gap. `visibility`: cosine
/// between the column and the normals.
double room_in_gap(double gap, double mean_edge, double visibility);

}  // namespace aeroloom::layers
