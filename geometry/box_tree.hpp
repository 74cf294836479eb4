/// A tree of bounding boxes: finds boxes that overlap another box, cross a ray, or are near a point. Its
/// leaves are compact groups of boxes.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::geometry {

/// Nodes are split at the median of the box centres, along the longest axis of the centres, down to at most
/// `leaf_size` boxes. The tree depends only on the boxes and their order. Immutable; queries do not allocate.
class BoxTree {
public:
  struct Node {
    Box box;
    std::int32_t begin, end;  ///< places in order()
    std::int32_t right = 0;   ///< child, 0 in a leaf; the left child follows its parent
    bool is_leaf() const { return right == 0; }
  };

  BoxTree() = default;
  BoxTree(std::span<const Box> boxes, int leaf_size);

  /// The root first; empty without boxes. For searches other than those below.
  std::span<const Node> nodes() const { return _nodes; }
  /// Indices of the boxes, leaf by leaf, ascending within a leaf.
  std::span<const std::int32_t> order() const { return _order; }
  /// The indices of each leaf's boxes, ascending within a leaf.
  std::vector<std::span<const std::int32_t>> leaves() const;

  /// Calls `visit(place)` for places in order(), ascending: those of leaves whose box, and the boxes of all
  /// nodes above, fulfil `enters(box)`.
  template <class Enters, class Visit>
  void search(const Enters& enters, const Visit& visit) const {
    std::int32_t stack[most_levels];
    int depth = 0;
    if (!_nodes.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::int32_t n = stack[--depth];
      const Node& node = _nodes[n];
      if (!enters(node.box)) continue;
      if (!node.is_leaf()) {
        stack[depth++] = node.right;
        stack[depth++] = n + 1;
        continue;
      }
      for (std::int32_t i = node.begin; i < node.end; ++i) visit(i);
    }
  }

  /// Calls `visit(place)` for the places of leaves whose `away(box)` is below `bound`, the nearer child
  /// first. `visit` may lower `bound`.
  template <class Away, class Visit>
  void search_nearest(const Away& away, const double& bound, const Visit& visit) const {
    struct Waiting {
      std::int32_t node;
      double away;
    };
    Waiting stack[most_levels];
    int depth = 0;
    if (!_nodes.empty()) stack[depth++] = {0, away(_nodes[0].box)};
    while (depth > 0) {
      const Waiting next = stack[--depth];
      if (!(next.away < bound)) continue;
      const Node& node = _nodes[next.node];
      if (node.is_leaf()) {
        for (std::int32_t i = node.begin; i < node.end; ++i) visit(i);
        continue;
      }
      const Waiting left{next.node + 1, away(_nodes[next.node + 1].box)};
      const Waiting right{node.right, away(_nodes[node.right].box)};
      const bool left_first = left.away <= right.away;
      stack[depth++] = left_first ? right : left;
      stack[depth++] = left_first ? left : right;
    }
  }

  /// The deepest stack that a search needs.
  static constexpr int most_levels = 64;

private:
  std::int32_t build(std::span<const Box> boxes, std::int32_t begin, std::int32_t end, int leaf_size);

  std::vector<std::int32_t> _order;
  std::vector<Node> _nodes;
};

/// Calls `visit(index)` for every box that overlaps `box`, in the tree's order. `tree` is the tree of
/// `boxes`.
template <class Visit>
void for_each_overlap(const BoxTree& tree, std::span<const Box> boxes, const Box& box, const Visit& visit) {
  tree.search([&](const Box& node) { return node.overlaps(box); },
              [&](std::int32_t place) {
                const std::int32_t i = tree.order()[place];
                if (boxes[i].overlaps(box)) visit(i);
              });
}

}  // namespace aeroloom::geometry
