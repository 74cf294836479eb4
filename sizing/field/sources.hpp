/// Sets of size sources: a canonical order, and thinning.
#pragma once

#include "sizing/field/size_field.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The cube that is the root of the octree over a domain.
struct RootCube {
  geometry::Vec3 low;
  double edge = 1;
  double cells_per_length = grid_size;  ///< finest cells

  /// The smallest cube around the domain with the same centre.
  explicit RootCube(const geometry::Box& domain);
  /// The finest cell that holds the point; the nearest one for points outside.
  GridPoint cell(geometry::Vec3 point) const;
  /// The coarsest level whose cells have at most this edge; the finest level for smaller ones.
  int level(double edge_length) const;
};

/// Keeps the smallest of the sources that fall into one octree cell of about their size: the field asks for a
/// source's size in the whole leaf around it anyway. Returns them in an order that depends on the set alone.
std::vector<SizeSource> thin_sources(const RootCube& root, std::span<const SizeSource> sources);

}  // namespace aeroloom::sizing
