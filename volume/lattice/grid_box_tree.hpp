/// A search tree over boxes of the lattice's grid.
#pragma once

#include "volume/lattice/lattice_frame.hpp"

#include <vector>

namespace aeroloom::volume {

/// Finds out whether any of many boxes is near a given box.
class GridBoxTree {
public:
  /// Boxes that are close in space should be added one after the other.
  void add(const GridBox& box) { _boxes.push_back(box); }
  /// Builds the tree, after all boxes were added.
  void build();
  /// Whether one of the boxes is at most `radius` away from `box`.
  bool any_within(const GridBox& box, double radius) const {
    return !_boxes.empty() && any_below(0, 0, _boxes.size(), box, radius);
  }

private:
  GridBox build(std::size_t node, std::size_t first, std::size_t last);
  bool any_below(std::size_t node, std::size_t first, std::size_t last, const GridBox& box,
                 double radius) const;

  std::vector<GridBox> _boxes;
  std::vector<GridBox> _nodes;  // children of node n: 2 n + 1, 2 n + 2
};

}  // namespace aeroloom::volume
