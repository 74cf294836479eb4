/// The smallest size that any of many sources allows at a point. Internal to sizing/.
#pragma once

#include "geometry/box_tree.hpp"
#include "sizing/field/size_field.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// Finds the least of size + slope * distance over sources, the same to the last bit as over all of them.
/// Sources of about one size have a tree of their own, from the smallest on.
class SourceTree {
public:
  /// `slope`: not negative.
  SourceTree(std::span<const SizeSource> sources, double slope);

  /// `most`, where no source allows less.
  double least(geometry::Vec3 point, double most) const;

private:
  struct Group {
    double smallest = 0;
    std::vector<SizeSource> sources;  ///< in the order of the tree
    geometry::BoxTree tree;
  };

  double _slope;
  std::vector<Group> _groups;  // ascending sizes
};

}  // namespace aeroloom::sizing
