/// Whether a box of the grid is near one of many.
#pragma once

#include "volume/lattice/lattice_frame.hpp"

#include <vector>

namespace aeroloom::volume {

/// A tree over boxes of the grid that tells whether one is near.
class NearBoxes {
public:
  /// Boxes that are near each other should follow each other.
  void add(const GridBox& box) { _boxes.push_back(box); }
  void build();
  /// Whether a box is at most `radius` away.
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
