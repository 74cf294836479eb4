#include "volume/lattice/grid_box_tree.hpp"

#include <algorithm>

namespace aeroloom::volume {

void GridBoxTree::build() {
  std::size_t nodes = 1;
  while (nodes < 2 * _boxes.size()) nodes *= 2;
  _nodes.assign(nodes, {});
  if (!_boxes.empty()) build(0, 0, _boxes.size());
}

GridBox GridBoxTree::build(std::size_t node, std::size_t first, std::size_t last) {
  if (last - first == 1) return _nodes[node] = _boxes[first];
  const std::size_t middle = first + (last - first) / 2;
  const GridBox a = build(2 * node + 1, first, middle), b = build(2 * node + 2, middle, last);
  return _nodes[node] = {
             {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
             {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

bool GridBoxTree::any_below(std::size_t node, std::size_t first, std::size_t last, const GridBox& box,
                            double radius) const {
  // Without a radius, a few comparisons decide.
  if (radius == 0 ? !_nodes[node].overlaps(box) : _nodes[node].gap_to(box) > radius) return false;
  if (last - first == 1) return true;
  const std::size_t middle = first + (last - first) / 2;
  return any_below(2 * node + 1, first, middle, box, radius) ||
         any_below(2 * node + 2, middle, last, box, radius);
}

}  // namespace aeroloom::volume
