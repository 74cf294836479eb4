#include "volume/boundary_distance.hpp"

#include <numeric>

namespace aeroloom::volume {

using geometry::Box;
using geometry::Vec3;

namespace {

constexpr std::int32_t leaf_size = 4;

/// Where on a triangle the point nearest to p lies (Ericson, Real-Time Collision Detection, 2005,
/// section 5.1.5).
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
    : _points(points), _triangles(triangles), _order(triangles.size()), _slot(triangles.size()) {
  const auto count = static_cast<std::int32_t>(triangles.size());
  _mean_edges.reserve(triangles.size());
  for (std::int32_t t = 0; t < count; ++t) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    _mean_edges.push_back((distance(a, b) + distance(b, c) + distance(c, a)) / 3.0);
  }
  std::iota(_order.begin(), _order.end(), 0);
  _nodes.reserve(triangles.size());
  build(0, count);
  _corners.reserve(triangles.size());
  for (std::int32_t slot = 0; slot < count; ++slot) {
    const std::int32_t t = _order[slot];
    _slot[t] = slot;
    _corners.push_back({corner(t, 0), corner(t, 1), corner(t, 2)});
  }
}

std::int32_t BoundaryDistance::build(std::int32_t first, std::int32_t last) {
  const auto index = static_cast<std::int32_t>(_nodes.size());
  summarise(first, last);
  if (last - first <= leaf_size) {
    _nodes[index].first = first;
    _nodes[index].count = last - first;
    return index;
  }
  const Vec3 size = _nodes[index].box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto place = [&](std::int32_t t) {
    return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis];
  };
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(_order.begin() + first, _order.begin() + middle, _order.begin() + last,
                   [&](std::int32_t s, std::int32_t t) {
                     const double ps = place(s), pt = place(t);
                     return ps < pt || (ps == pt && s < t);
                   });
  build(first, middle);
  const std::int32_t right = build(middle, last);
  _nodes[index].right = right;
  return index;
}

void BoundaryDistance::summarise(std::int32_t first, std::int32_t last) {
  Node& node = _nodes.emplace_back();
  for (std::int32_t i = first; i < last; ++i) {
    for (int k = 0; k < 3; ++k) node.box.add(corner(_order[i], k));
  }
}

double BoundaryDistance::squared_distance(Vec3 p, const Corners& triangle, bool& in_face) {
  const Vec3 foot = foot_on(p, triangle.a, triangle.b, triangle.c, in_face);
  return dot(p - foot, p - foot);
}

Vec3 BoundaryDistance::foot_point(Vec3 p, std::int32_t triangle) const {
  bool in_face = false;
  const Corners& corners = _corners[_slot[triangle]];
  return foot_on(p, corners.a, corners.b, corners.c, in_face);
}

BoundaryDistance::Nearest BoundaryDistance::nearest(Vec3 p, std::int32_t guess, double range) const {
  Nearest best;
  double best_squared = range * range;
  const auto look_at = [&](std::int32_t slot) {
    bool in_face = false;
    const double squared = squared_distance(p, _corners[slot], in_face);
    if (squared < best_squared) {
      best_squared = squared;
      best.triangle = _order[slot];
      best.in_face = in_face;
    }
  };
  if (guess >= 0) look_at(_slot[guess]);
  struct Entry {
    std::int32_t node;
    double squared;
  };
  Entry stack[64];
  int depth = 0;
  stack[depth++] = {0, squared_distance(p, _nodes[0].box)};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.squared >= best_squared) continue;
    const Node& node = _nodes[entry.node];
    if (node.count == 0) {
      Entry near{entry.node + 1, squared_distance(p, _nodes[entry.node + 1].box)};
      Entry far{node.right, squared_distance(p, _nodes[node.right].box)};
      if (far.squared < near.squared) std::swap(near, far);
      if (far.squared < best_squared) stack[depth++] = far;
      if (near.squared < best_squared) stack[depth++] = near;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) look_at(i);
  }
  best.distance = best.triangle < 0 ? range : std::sqrt(best_squared);
  return best;
}

void BoundaryDistance::for_each_overlapping_pair(
    const std::function<void(std::int32_t, std::int32_t)>& visit) const {
  std::vector<std::pair<std::int32_t, std::int32_t>> stack{{0, 0}};
  const auto visit_leaves = [&](const Node& a, const Node& b, bool same) {
    for (std::int32_t i = 0; i < a.count; ++i) {
      for (std::int32_t j = same ? i + 1 : 0; j < b.count; ++j) {
        visit(std::min(_order[a.first + i], _order[b.first + j]),
              std::max(_order[a.first + i], _order[b.first + j]));
      }
    }
  };
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &a = _nodes[i], &b = _nodes[j];
    if (!a.box.overlaps(b.box)) continue;
    if (a.count > 0 && b.count > 0) {
      visit_leaves(a, b, i == j);
    } else if (i == j) {
      stack.insert(stack.end(), {{i + 1, i + 1}, {a.right, a.right}, {i + 1, a.right}});
    } else if (b.count > 0 || (a.count == 0 && a.box.diagonal() >= b.box.diagonal())) {
      stack.insert(stack.end(), {{i + 1, j}, {a.right, j}});
    } else {
      stack.insert(stack.end(), {{i, j + 1}, {i, b.right}});
    }
  }
}

}  // namespace aeroloom::volume
