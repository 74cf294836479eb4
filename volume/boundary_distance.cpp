#include "volume/boundary_distance.hpp"

#include "geometry/predicates.hpp"

#include <numbers>
#include <numeric>

namespace aeroloom::volume {

using geometry::Box;
using geometry::Vec3;

namespace {

constexpr std::int32_t leaf_size = 4;
/// A node is seen as a dipole from this many of its radii.
constexpr double far_ratio = 2.0;

/// Where on a triangle the point nearest to p lies (Ericson, Real-Time Collision Detection, 2005,
/// section 5.1.5).
Vec3 foot_point(Vec3 p, Vec3 a, Vec3 b, Vec3 c, bool& in_face) {
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

/// The solid angle of a triangle seen from the origin, positive from its inner side (Van Oosterom, Strackee,
/// IEEE Trans. Biomed. Eng. 30, 1983, doi:10.1109/TBME.1983.325207).
double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double numerator = dot(a, cross(b, c));
  const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2.0 * std::atan2(numerator, denominator);
}

}  // namespace

BoundaryDistance::BoundaryDistance(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : _points(points), _triangles(triangles), _mean_edges(triangles.size()), _order(triangles.size()) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto i = static_cast<std::int32_t>(t);
    _mean_edges[t] = (distance(corner(i, 0), corner(i, 1)) + distance(corner(i, 1), corner(i, 2)) +
                      distance(corner(i, 2), corner(i, 0))) /
                     3.0;
  }
  std::iota(_order.begin(), _order.end(), 0);
  _nodes.reserve(triangles.size());
  build(0, static_cast<std::int32_t>(triangles.size()));
}

std::int32_t BoundaryDistance::build(std::int32_t first, std::int32_t last) {
  const auto index = static_cast<std::int32_t>(_nodes.size());
  Node node;
  summarise(node, first, last);
  _nodes.push_back(node);
  if (last - first <= leaf_size) {
    _nodes[index].first = first;
    _nodes[index].count = last - first;
    return index;
  }
  const Vec3 size = node.box.size();
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

void BoundaryDistance::summarise(Node& node, std::int32_t first, std::int32_t last) const {
  double area_sum = 0;
  Vec3 moment;
  for (std::int32_t i = first; i < last; ++i) {
    const Vec3 a = corner(_order[i], 0), b = corner(_order[i], 1), c = corner(_order[i], 2);
    node.box.add(a), node.box.add(b), node.box.add(c);
    const Vec3 area = 0.5 * cross(b - a, c - a);
    node.normal += area;
    area_sum += norm(area);
    moment += (norm(area) / 3.0) * (a + b + c);
  }
  node.center = area_sum > 0 ? moment / area_sum : node.box.center();
  for (std::int32_t i = first; i < last; ++i) {
    for (int k = 0; k < 3; ++k)
      node.radius = std::max(node.radius, distance(node.center, corner(_order[i], k)));
  }
}

double BoundaryDistance::squared_distance(Vec3 p, std::int32_t triangle, bool& in_face) const {
  const Vec3 foot = foot_point(p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2), in_face);
  return dot(p - foot, p - foot);
}

BoundaryDistance::Nearest BoundaryDistance::nearest(Vec3 p, std::int32_t guess) const {
  Nearest best;
  double best_squared = 1e300;
  if (guess >= 0) {
    best.triangle = guess;
    best_squared = squared_distance(p, guess, best.in_face);
  }
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
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      bool in_face = false;
      const double squared = squared_distance(p, _order[i], in_face);
      if (squared < best_squared) {
        best_squared = squared;
        best.triangle = _order[i];
        best.in_face = in_face;
      }
    }
  }
  best.distance = std::sqrt(best_squared);
  return best;
}

bool BoundaryDistance::inside(Vec3 p) const {
  return winding_number(p) > 0.5;
}

bool BoundaryDistance::inside(Vec3 p, const Nearest& nearest) const {
  // Nothing lies between p and a foot point inside a face, so that face's side decides.
  if (nearest.in_face) {
    const int side = geometry::orient3d(corner(nearest.triangle, 0), corner(nearest.triangle, 1),
                                        corner(nearest.triangle, 2), p);
    if (side != 0) return side < 0;
  }
  return inside(p);
}

double BoundaryDistance::winding_number(Vec3 p) const {
  double solid = 0;
  std::int32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t index = stack[--depth];
    const Node& node = _nodes[index];
    const Vec3 away = node.center - p;
    const double range = norm(away);
    if (range > far_ratio * node.radius) {
      solid += dot(away, node.normal) / (range * range * range);
    } else if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    } else {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        solid += solid_angle(corner(_order[i], 0) - p, corner(_order[i], 1) - p, corner(_order[i], 2) - p);
      }
    }
  }
  return solid / (4.0 * std::numbers::pi);
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
    } else if (b.count > 0 || (a.count == 0 && a.radius >= b.radius)) {
      stack.insert(stack.end(), {{i + 1, j}, {a.right, j}});
    } else {
      stack.insert(stack.end(), {{i, j + 1}, {i, b.right}});
    }
  }
}

}  // namespace aeroloom::volume
