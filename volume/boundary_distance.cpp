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
    : _points(points), _triangles(triangles), _order(triangles.size()), _slot(triangles.size()) {
  const auto count = static_cast<std::int32_t>(triangles.size());
  _mean_edges.reserve(triangles.size());
  for (std::int32_t t = 0; t < count; ++t) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    _mean_edges.push_back((distance(a, b) + distance(b, c) + distance(c, a)) / 3.0);
  }
  std::iota(_order.begin(), _order.end(), 0);
  _nodes.reserve(triangles.size());
  _dipoles.reserve(triangles.size());
  build(0, count);
  _corners.reserve(triangles.size());
  for (std::int32_t slot = 0; slot < count; ++slot) {
    const std::int32_t t = _order[slot];
    _slot[t] = slot;
    _corners.push_back({corner(t, 0), corner(t, 1), corner(t, 2)});
  }
  list_neighbours();
}

void BoundaryDistance::list_neighbours() {
  _first_around.assign(_points.size() + 1, 0);
  for (const Triangle& t : _triangles) {
    for (const auto v : t) ++_first_around[v + 1];
  }
  std::partial_sum(_first_around.begin(), _first_around.end(), _first_around.begin());
  _around.resize(3 * _triangles.size());
  std::vector<std::int32_t> next(_first_around.begin(), _first_around.end() - 1);
  for (std::size_t slot = 0; slot < _order.size(); ++slot) {
    for (const auto v : _triangles[_order[slot]]) _around[next[v]++] = static_cast<std::int32_t>(slot);
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
  Dipole& dipole = _dipoles.emplace_back();
  double area_sum = 0;
  Vec3 moment;
  for (std::int32_t i = first; i < last; ++i) {
    const Vec3 a = corner(_order[i], 0), b = corner(_order[i], 1), c = corner(_order[i], 2);
    node.box.add(a), node.box.add(b), node.box.add(c);
    const Vec3 area = 0.5 * cross(b - a, c - a);
    dipole.normal += area;
    area_sum += norm(area);
    moment += (norm(area) / 3.0) * (a + b + c);
  }
  dipole.center = area_sum > 0 ? moment / area_sum : node.box.center();
  for (std::int32_t i = first; i < last; ++i) {
    for (int k = 0; k < 3; ++k) {
      dipole.radius = std::max(dipole.radius, distance(dipole.center, corner(_order[i], k)));
    }
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

bool BoundaryDistance::inside(Vec3 p) const {
  return winding_number(p) > 0.5;
}

bool BoundaryDistance::inside(Vec3 p, const Nearest& nearest) const {
  if (nearest.triangle >= 0) {
    const int side =
        nearest.in_face ? side_of(p, nearest.triangle) : side_of_neighbourhood(p, nearest.triangle);
    if (side != 0) return side < 0;
  }
  return inside(p);
}

/// Nothing lies between p and a foot point inside a face, so that face's side decides.
int BoundaryDistance::side_of(Vec3 p, std::int32_t triangle) const {
  const Corners& corners = _corners[_slot[triangle]];
  return geometry::orient3d(corners.a, corners.b, corners.c, p);
}

/// The side p is on of all triangles that share a point with its nearest one, 0 if not of all the same. With
/// the foot point on an edge or point of the surface, one of the triangles there decides; when all agree it
/// is known.
int BoundaryDistance::side_of_neighbourhood(Vec3 p, std::int32_t triangle) const {
  const int side = side_of(p, triangle);
  for (const auto v : _triangles[triangle]) {
    for (std::int32_t i = _first_around[v]; i < _first_around[v + 1]; ++i) {
      const Corners& corners = _corners[_around[i]];
      if (geometry::orient3d(corners.a, corners.b, corners.c, p) != side) return 0;
    }
  }
  return side;
}

double BoundaryDistance::winding_number(Vec3 p) const {
  double solid = 0;
  std::int32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t index = stack[--depth];
    const Node& node = _nodes[index];
    const Dipole& dipole = _dipoles[index];
    const Vec3 away = dipole.center - p;
    const double range = norm(away);
    if (range > far_ratio * dipole.radius) {
      solid += dot(away, dipole.normal) / (range * range * range);
    } else if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    } else {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        solid += solid_angle(_corners[i].a - p, _corners[i].b - p, _corners[i].c - p);
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
    } else if (b.count > 0 || (a.count == 0 && _dipoles[i].radius >= _dipoles[j].radius)) {
      stack.insert(stack.end(), {{i + 1, j}, {a.right, j}});
    } else {
      stack.insert(stack.end(), {{i, j + 1}, {i, b.right}});
    }
  }
}

}  // namespace aeroloom::volume
