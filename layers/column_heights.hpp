/// The heights of the nodes in one column of boundary-layer nodes.
#pragma once

#include "layers/columns.hpp"

#include <cstdint>

namespace aeroloom::layers {

/// The largest number of layers in a column.
inline constexpr std::int32_t most_layers = 1000;

/// A geometric column: `constant` layers of height `first`, then each `growth` times the one below. The last
/// ones may grow more, or less.
struct Heights {
  double first = 0, growth = 1;
  std::int32_t constant = 1;
  std::int32_t regular = most_layers;  ///< each layer above this one is in addition `stretch` times as high
  double stretch = 1;

  bool operator==(const Heights&) const = default;
  /// Calls visit(k, height of node k) for k = 1 ... count. All nodes are placed by this sum.
  template <class Visit>
  void for_each_node(std::int32_t count, const Visit& visit) const {
    double layer = first, sum = 0;
    for (std::int32_t k = 1; k <= count; ++k) {
      if (k > constant) layer *= growth;
      if (k > regular) layer *= stretch;
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
    for (std::int32_t k = 1; k <= count; ++k) {
      if (k > constant) layer *= growth;
      if (k > regular) layer *= stretch;
    }
    return layer;
  }
};

/// Of a column of a piece.
Heights heights(const PieceColumns& columns, mesh::LocalIndex vertex);

/// Calls visit(k, node(..., k)) for the nodes of a column off the wall.
template <class Visit>
void for_each_node(const mesh::Piece& wall, const PieceColumns& columns, std::int32_t column,
                   const Visit& visit) {
  const mesh::LocalIndex vertex = columns.vertex_of(column);
  const geometry::Vec3 foot = wall.point(vertex), direction = columns.directions[column];
  const geometry::Vec3* curved = columns.curved_nodes_of(column);
  heights(columns, vertex).for_each_node(columns.counts[vertex], [&](std::int32_t k, double height) {
    visit(k, curved != nullptr ? curved[k - 1] : foot + height * direction);
  });
}

/// Height over the mean edge of a prism that is about as good as a tetrahedron.
inline constexpr double isotropic_height = 0.7;

/// Least height of a last layer, over the mean edge, at which the step to the tetrahedra is still smooth:
/// half of what is aimed at.
inline constexpr double smooth_end = 0.5 * isotropic_height;

/// The number of layers of a column without stretch, at least 1, so that the last layer is about 0.7 of the
/// mean edge length at the vertex. Count and total height in `wanted` are upper bounds.
std::int32_t wanted_count(const WallLayers& wanted, double mean_edge);

/// The largest number of layers, at most `count`, that are together no higher than `limit`.
std::int32_t layers_below(const Heights& heights, std::int32_t count, double limit);

/// The end of a column: how many layers it has, and how the last ones are stretched (Heights).
struct FittedLayers {
  std::int32_t count = 0, regular = most_layers;
  double stretch = 1;

  bool operator==(const FittedLayers&) const = default;
};

/// Layers that are together about a factor of two in height: 7 at a growth of 1.1, 4 at 1.2, 2 at 1.5; at
/// most `longest_step`.
std::int32_t layers_in_a_step(double growth);
inline constexpr std::int32_t longest_step = 8;

/// At most `count` layers that are together as high as `limit`, the last about as high as `last`. The last
/// ones, one more than layers_in_a_step, grow by 1 to 1.5 (1.25 times the growth where that is more) from one
/// to the next (less among layers of constant height), so that the number of layers is a multiple of that
/// step or `count`: neighbours with about the same limit have as many. Of fewer layers only the last is
/// stretched. A first layer never is, and is left out where it is higher than the limit. `heights` without
/// stretch.
FittedLayers fit_layers(const Heights& heights, std::int32_t count, double limit, double last);

/// The layers that `wanted` asks for, at least one: those that are together as high as a column whose last
/// layer is 0.7 of the mean edge length at the vertex. Count and total height in `wanted` are upper bounds.
FittedLayers wanted_layers(const WallLayers& wanted, double mean_edge);

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
