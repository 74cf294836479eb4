/// The one tree of boxes: spatially compact leaves, and the boxes that overlap another, are crossed by a ray,
/// or are near a point.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::geometry {

/// Split at the median of the boxes' centres along the longest axis of these, down to leaves of `leaf_size`
/// boxes at most. A function of the boxes and their order alone. Immutable; queries do not allocate.
class BoxTree {
public:
  struct Node {
    Box box;
    std::int32_t begin, end;  ///< of order()
    std::int32_t right = 0;   ///< child; the left one follows its parent; 0 in a leaf
    bool is_leaf() const { return right == 0; }
  };

  BoxTree() = default;
  BoxTree(std::span<const Box> boxes, int leaf_size);

  /// The root first; empty without boxes. For searches that choose their own way.
  std::span<const Node> nodes() const { return _nodes; }
  /// Indices of the boxes, leaf by leaf, ascending within a leaf.
  std::span<const std::int32_t> order() const { return _order; }
  /// The indices of each leaf's boxes, ascending within a leaf.
  std::vector<std::span<const std::int32_t>> leaves() const;

  /// Calls `visit(place)` for the places in order() of all leaves that are reached through nodes with
  /// `enters(box)`, ascending.
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

  /// Calls `visit(place)` for the places of leaves reached through nodes with away(box) below `bound`, which
  /// visit may lower; the nearer child first.
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

/// Calls `visit(index)` for every one of the boxes that overlaps `box`, in the tree's order; the tree is that
/// of the boxes.
template <class Visit>
void for_each_overlap(const BoxTree& tree, std::span<const Box> boxes, const Box& box, const Visit& visit) {
  tree.search([&](const Box& node) { return node.overlaps(box); },
              [&](std::int32_t place) {
                const std::int32_t i = tree.order()[place];
                if (boxes[i].overlaps(box)) visit(i);
              });
}

}  // namespace aeroloom::geometry
