/// The root cube of an octree, and how sets of size sources are thinned.
#pragma once

#include "sizing/field/size_field.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The root cube of the octree over a domain.
struct RootCube {
  geometry::Vec3 low;
  double edge = 1;
  double cells_per_length = grid_size;  ///< finest cells

  /// The smallest cube around the domain, with the same centre.
  explicit RootCube(const geometry::Box& domain);
  /// The finest cell that holds the point; for points outside, the nearest one.
  GridPoint cell(geometry::Vec3 point) const;
  /// The coarsest level whose cells have at most this edge. The finest level where none has.
  int level(double edge_length) const;
};

/// Of the sources in one octree cell of about their size, keeps only the smallest: the field has its size in
/// the whole leaf anyway. The order of the result depends on the set of sources alone.
std::vector<SizeSource> thin_sources(const RootCube& root, std::span<const SizeSource> sources);

}  // namespace aeroloom::sizing
