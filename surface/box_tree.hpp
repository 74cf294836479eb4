/// A balanced tree of boxes: spatially compact leaves, and the boxes that overlap a given one.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// Split at the median of the boxes' centres along the longest axis, down to leaves of `leaf_size` boxes at
/// most. A function of the boxes and their order alone.
class BoxTree {
public:
  BoxTree(std::vector<geometry::Box> boxes, int leaf_size);

  /// The indices of each leaf's boxes, ascending within a leaf.
  std::vector<std::span<const std::int32_t>> leaves() const;

  /// Calls `visit(index)` for every box that overlaps `box`, in the tree's order.
  template <class Visitor>
  void for_each_overlap(const geometry::Box& box, Visitor&& visit) const {
    if (!_nodes.empty()) descend(0, box, visit);
  }

private:
  struct Node {
    geometry::Box box;
    std::int32_t begin, end;  ///< of _order
    std::int32_t right = 0;   ///< child; the left one follows its parent; 0 in a leaf
  };
  std::int32_t build(std::int32_t begin, std::int32_t end, int leaf_size);

  template <class Visitor>
  void descend(std::int32_t n, const geometry::Box& box, Visitor&& visit) const {
    const Node& node = _nodes[n];
    if (!node.box.overlaps(box)) return;
    if (node.right != 0) {
      descend(n + 1, box, visit);
      descend(node.right, box, visit);
      return;
    }
    for (std::int32_t i = node.begin; i < node.end; ++i) {
      if (_boxes[_order[i]].overlaps(box)) visit(_order[i]);
    }
  }

  std::vector<geometry::Box> _boxes;
  std::vector<std::int32_t> _order;
  std::vector<Node> _nodes;
};

}  // namespace aeroloom::surface
