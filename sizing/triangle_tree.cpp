#include "sizing/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace aeroloom::sizing {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr std::int32_t triangles_per_leaf = 4;
constexpr std::size_t most_candidates = 64;  // that are looked at one by one

Box box_of(const Triangle& t) {
  Box box;
  for (const Vec3 p : t) box.add(p);
  return box;
}

/// Whether the plane of the triangle passes through the open cube.
bool plane_cuts(const Triangle& t, Vec3 center, double half_edge) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double reach = half_edge * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  return std::abs(dot(normal, center - t[0])) < reach;
}

bool boxes_overlap_inside(const Box& box, Vec3 low, double edge) {
  return box.low.x < low.x + edge && box.high.x > low.x && box.low.y < low.y + edge && box.high.y > low.y &&
         box.low.z < low.z + edge && box.high.z > low.z;
}

/// Whether the ray meets the box (slabs).
bool ray_meets(const Box& box, Vec3 point, Vec3 inverse, double reach = 1e300) {
  double enter = 0, leave = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - point[axis]) * inverse[axis],
                 b = (box.high[axis] - point[axis]) * inverse[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

/// Where the ray crosses the triangle, in lengths of the direction (Moeller and Trumbore, J. Graphics Tools
/// 2, 1997, doi:10.1080/10867651.1997.10487468).
std::optional<double> ray_crossing(const Triangle& t, Vec3 point, Vec3 direction) {
  const Vec3 edge1 = t[1] - t[0], edge2 = t[2] - t[0], p = cross(direction, edge2);
  const double determinant = dot(edge1, p);
  if (determinant == 0) return std::nullopt;
  const Vec3 s = point - t[0], q = cross(s, edge1);
  const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
  const double away = dot(edge2, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && away > 0)) return std::nullopt;
  return away;
}

double squared_distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double square = dot(along, along);
  const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
  const Vec3 d = p - a - t * along;
  return dot(d, d);
}

double squared_distance(Vec3 p, const Triangle& t) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double square = dot(normal, normal);
  bool inside = square > 0;
  for (int i = 0; i < 3 && inside; ++i) inside = dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), normal) >= 0;
  if (inside) {
    const double height = dot(normal, p - t[0]);
    return height * height / square;
  }
  return std::min({squared_distance_to_segment(p, t[0], t[1]), squared_distance_to_segment(p, t[1], t[2]),
                   squared_distance_to_segment(p, t[2], t[0])});
}

}  // namespace

TriangleTree::TriangleTree(std::vector<Triangle> triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) boxes.push_back(box_of(t));
  _tree = geometry::BoxTree(boxes, triangles_per_leaf);
  _triangles.reserve(triangles.size());
  _boxes.reserve(triangles.size());
  for (const std::int32_t t : _tree.order()) {
    _triangles.push_back(triangles[t]);
    _boxes.push_back(boxes[t]);
  }
}

bool TriangleTree::overlaps_inside(std::int32_t triangle, Vec3 low, double edge) const {
  return boxes_overlap_inside(_boxes[triangle], low, edge) &&
         plane_cuts(_triangles[triangle], low + 0.5 * edge * Vec3{1, 1, 1}, 0.5 * edge);
}

void TriangleTree::find_overlapping(Vec3 low, double edge, std::vector<std::int32_t>& found) const {
  found.clear();
  _tree.search([&](const Box& box) { return boxes_overlap_inside(box, low, edge); },
               [&](std::int32_t t) {
                 if (overlaps_inside(t, low, edge)) found.push_back(t);
               });
}

void TriangleTree::keep_overlapping(Vec3 low, double edge, std::span<const std::int32_t> candidates,
                                    std::vector<std::int32_t>& found) const {
  // Of many, few are likely to be near.
  if (candidates.size() > most_candidates) return find_overlapping(low, edge, found);
  found.clear();
  for (const std::int32_t t : candidates) {
    if (overlaps_inside(t, low, edge)) found.push_back(t);
  }
}

bool TriangleTree::odd_crossings(Vec3 point, Vec3 direction) const {
  const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  bool odd = false;
  _tree.search([&](const Box& box) { return ray_meets(box, point, inverse); },
               [&](std::int32_t t) {
                 if (ray_crossing(_triangles[t], point, direction)) odd = !odd;
               });
  return odd;
}

void TriangleTree::find_crossings(Vec3 point, Vec3 direction, double reach,
                                  std::vector<Crossing>& found) const {
  const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  _tree.search([&](const Box& box) { return ray_meets(box, point, inverse, reach); },
               [&](std::int32_t t) {
                 const std::optional<double> away = ray_crossing(_triangles[t], point, direction);
                 if (away && *away <= reach) found.push_back({t, *away});
               });
}

bool TriangleTree::contains(Vec3 point) const {
  // No direction is likely to run along facets.
  const int votes = int{odd_crossings(point, {0.8191, 0.4271, 0.3829})} +
                    int{odd_crossings(point, {-0.3137, 0.7873, -0.5308})} +
                    int{odd_crossings(point, {0.2719, -0.6133, -0.7416})};
  return votes >= 2;
}

double TriangleTree::share_behind(Vec3 low, double edge, std::span<const std::int32_t> triangles) const {
  const Vec3 middle = low + 0.5 * edge * Vec3{1, 1, 1};
  double nearest = 1e300, side = 0;
  Vec3 direction;
  for (const std::int32_t i : triangles) {
    const Triangle& t = _triangles[i];
    const double square = squared_distance(middle, t);
    if (square > nearest * (1 + 1e-9)) continue;
    const Vec3 normal = geometry::normalized(cross(t[1] - t[0], t[2] - t[0]));
    const double height = dot(normal, middle - t[0]);
    // Where two facets meet at the nearest place, the one seen more directly tells the side.
    const bool tie = square >= nearest * (1 - 1e-9);
    if (!tie || std::abs(height) > std::abs(side)) side = height, direction = normal;
    nearest = std::min(nearest, square);
  }
  // A facet that is seen past its border is farther away than its plane.
  const double away = std::copysign(std::sqrt(nearest), side);
  const double width = edge * (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  return std::clamp(0.5 - away / std::max(width, 1e-300), 0.0, 1.0);
}

}  // namespace aeroloom::sizing
