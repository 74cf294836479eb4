#include "volume/lattice/boundary_distance.hpp"

#include <limits>

namespace aeroloom::volume {

using geometry::Box;
using geometry::Vec3;

namespace {

using Node = geometry::BoxTree::Node;

constexpr int leaf_size = 4;  // triangles; chosen, not measured

/// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
Vec3 foot_on(Vec3 p, Vec3 a, Vec3 b, Vec3 c, bool& in_face) {
  in_face = false;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  in_face = true;
  const double scale = 1.0 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

}  // namespace

BoundaryDistance::BoundaryDistance(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : _points(points), _triangles(triangles), _slot(triangles.size()) {
  const auto count = static_cast<std::int32_t>(triangles.size());
  std::vector<Box> boxes(triangles.size());
  for (std::int32_t t = 0; t < count; ++t) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    for (const Vec3 p : {a, b, c}) boxes[t].add(p);
  }
  _tree = geometry::BoxTree(boxes, leaf_size);
  _corners.reserve(triangles.size());
  _mean_edges.reserve(triangles.size());
  for (const std::int32_t t : _tree.order()) {
    _slot[t] = static_cast<std::int32_t>(_corners.size());
    const auto& [a, b, c] = _corners.emplace_back(Corners{corner(t, 0), corner(t, 1), corner(t, 2)});
    _mean_edges.push_back((distance(a, b) + distance(b, c) + distance(c, a)) / 3.0);
  }
}

BoundaryDistance::SquaredDistance BoundaryDistance::squared_distance(Vec3 p, const Corners& triangle) {
  bool in_face = false;
  const Vec3 foot = foot_on(p, triangle.a, triangle.b, triangle.c, in_face);
  return {dot(p - foot, p - foot), in_face};
}

bool BoundaryDistance::any_in(const Box& box) const {
  bool found = false;
  _tree.search([&](const Box& node) { return !found && node.overlaps(box); },
               [&](std::int32_t) { found = true; });
  return found;
}

Vec3 BoundaryDistance::foot_point(Vec3 p, std::int32_t triangle) const {
  bool in_face = false;
  const Corners& corners = _corners[_slot[triangle]];
  return foot_on(p, corners.a, corners.b, corners.c, in_face);
}

BoundaryDistance::Nearest BoundaryDistance::nearest(Vec3 p, std::int32_t guess) const {
  const auto nodes = _tree.nodes();
  const auto order = _tree.order();
  Nearest best;
  double best_squared = std::numeric_limits<double>::infinity();
  const auto look_at = [&](std::int32_t slot) {
    const auto [squared, in_face] = squared_distance(p, _corners[slot]);
    if (squared < best_squared) {
      best_squared = squared;
      best.triangle = order[slot];
      best.in_face = in_face;
    }
  };
  if (guess >= 0) look_at(_slot[guess]);
  struct QueuedNode {
    std::int32_t node;
    double squared;
  };
  QueuedNode stack[geometry::BoxTree::most_levels];
  int depth = 0;
  stack[depth++] = {0, squared_distance(p, nodes[0].box)};
  while (depth > 0) {
    const QueuedNode entry = stack[--depth];
    if (entry.squared >= best_squared) continue;
    const Node& node = nodes[entry.node];
    if (!node.is_leaf()) {
      QueuedNode near{entry.node + 1, squared_distance(p, nodes[entry.node + 1].box)};
      QueuedNode far{node.right, squared_distance(p, nodes[node.right].box)};
      if (far.squared < near.squared) std::swap(near, far);
      if (far.squared < best_squared) stack[depth++] = far;
      if (near.squared < best_squared) stack[depth++] = near;
      continue;
    }
    for (std::int32_t i = node.begin; i < node.end; ++i) look_at(i);
  }
  best.distance = std::sqrt(best_squared);
  return best;
}

void BoundaryDistance::for_each_overlapping_pair(
    const std::function<void(std::int32_t, std::int32_t)>& visit) const {
  const auto nodes = _tree.nodes();
  const auto order = _tree.order();
  std::vector<std::pair<std::int32_t, std::int32_t>> stack{{0, 0}};
  const auto visit_leaves = [&](const Node& a, const Node& b, bool same) {
    for (std::int32_t i = a.begin; i < a.end; ++i) {
      for (std::int32_t j = same ? i + 1 : b.begin; j < b.end; ++j)
        visit(std::min(order[i], order[j]), std::max(order[i], order[j]));
    }
  };
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &a = nodes[i], &b = nodes[j];
    if (!a.box.overlaps(b.box)) continue;
    if (a.is_leaf() && b.is_leaf()) {
      visit_leaves(a, b, i == j);
    } else if (i == j) {
      stack.insert(stack.end(), {{i + 1, i + 1}, {a.right, a.right}, {i + 1, a.right}});
    } else if (b.is_leaf() || (!a.is_leaf() && a.box.diagonal() >= b.box.diagonal())) {
      stack.insert(stack.end(), {{i + 1, j}, {a.right, j}});
    } else {
      stack.insert(stack.end(), {{i, j + 1}, {i, b.right}});
    }
  }
}

}  // namespace aeroloom::volume
