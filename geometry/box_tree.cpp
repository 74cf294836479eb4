#include "geometry/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::geometry {

BoxTree::BoxTree(std::span<const Box> boxes, int leaf_size) : _order(boxes.size()) {
  std::iota(_order.begin(), _order.end(), 0);
  if (!_order.empty()) build(boxes, 0, static_cast<std::int32_t>(_order.size()), leaf_size);
}

std::int32_t BoxTree::build(std::span<const Box> boxes, std::int32_t begin, std::int32_t end, int leaf_size) {
  const auto number = static_cast<std::int32_t>(_nodes.size());
  Node node{{}, begin, end};
  Box centers;
  for (std::int32_t i = begin; i < end; ++i) {
    node.box.add(boxes[_order[i]]);
    centers.add(boxes[_order[i]].center());
  }
  _nodes.push_back(node);
  const auto first = _order.begin() + begin, last = _order.begin() + end;
  if (end - begin <= leaf_size) {
    std::sort(first, last);
    return number;
  }
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(first, _order.begin() + middle, last, [&](std::int32_t a, std::int32_t b) {
    const double left = boxes[a].low[axis] + boxes[a].high[axis],
                 right = boxes[b].low[axis] + boxes[b].high[axis];
    return left != right ? left < right : a < b;
  });
  build(boxes, begin, middle, leaf_size);
  const std::int32_t right = build(boxes, middle, end, leaf_size);
  _nodes[number].right = right;
  return number;
}

std::vector<std::span<const std::int32_t>> BoxTree::leaves() const {
  std::vector<std::span<const std::int32_t>> leaves;
  for (const Node& node : _nodes) {
    if (node.is_leaf()) leaves.emplace_back(_order.data() + node.begin, node.end - node.begin);
  }
  return leaves;
}

}  // namespace aeroloom::geometry
