#include "sizing/features/triangle_tree.hpp"

#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aeroloom::sizing {
namespace {

using geometry::Box;
using geometry::orient2d;
using geometry::Vec2;
using geometry::Vec3;

constexpr std::int32_t triangles_per_leaf = 4;  // chosen, not measured
constexpr std::size_t most_candidates = 512;    // that are looked at one by one; chosen, not measured
constexpr double least_length = 1e-300;         // in place of one of nothing, to divide by

Box box_of(const Triangle& t) {
  Box box;
  for (const Vec3 p : t) box.add(p);
  return box;
}

// Slender triangles that run along no axis have boxes of that many parts, none shorter than a few times the
// triangle is wide: one box would hold far more than the triangle (early split clipping; Ernst and Greiner,
// Symposium on Interactive Ray Tracing, 2007, doi:10.1109/RT.2007.4342593).
constexpr double most_boxes = 16, box_over_width = 4;
constexpr double slack = 1e-9;  // of a box, over the triangle's length: points of its edges are rounded
/// Two squared distances are equal, and one is not less than another that is computed through a product of
/// normals: what rounding leaves, with some digits to spare.
constexpr double equal = 1e-9, not_less = 1e-8;

/// The boxes of a triangle: of its parts along its longest edge where it is slender.
void add_boxes(const Triangle& t, std::vector<Box>& boxes) {
  const Box whole = box_of(t);
  const auto [from, length] = longest_edge(t);
  const Vec3 a = t[from], b = t[(from + 1) % 3], c = t[(from + 2) % 3];
  const double height = length > 0 ? norm(cross(b - a, c - a)) / length : 0;
  const Vec3 size = whole.size();
  const double second =
      size.x + size.y + size.z - std::max({size.x, size.y, size.z}) - std::min({size.x, size.y, size.z});
  const double parts =
      std::floor(std::min(most_boxes, length / std::max(box_over_width * height, least_length)));
  if (parts < 2 || second < box_over_width * height) {
    boxes.push_back(whole);
    return;
  }
  const double foot = std::clamp(dot(c - a, b - a) / (length * length), 0.0, 1.0);
  const auto above = [&](double s) {
    return s < foot ? a + s / foot * (c - a) : foot < 1 ? c + (s - foot) / (1 - foot) * (b - c) : c;
  };
  const double around = slack * length;
  for (int i = 0; i < static_cast<int>(parts); ++i) {
    const double first = i / parts, last = (i + 1) / parts;
    Box box;
    for (const double s : {first, last}) box.add(a + s * (b - a)), box.add(above(s));
    if (first <= foot && foot <= last) box.add(c);
    box.low = box.low - Vec3{around, around, around};
    box.high = box.high + Vec3{around, around, around};
    boxes.push_back(box);
  }
}

bool boxes_overlap_inside(const Box& box, Vec3 low, double edge) {
  return box.low.x < low.x + edge && box.high.x > low.x && box.low.y < low.y + edge && box.high.y > low.y &&
         box.low.z < low.z + edge && box.high.z > low.z;
}

double squared_distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double square = dot(along, along);
  const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
  const Vec3 d = p - a - t * along;
  return dot(d, d);
}

double squared_distance(Vec3 p, const Triangle& t, Vec3 normal) {
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

LongestEdge longest_edge(const Triangle& t) {
  LongestEdge longest;
  for (int i = 0; i < 3; ++i) {
    const double length = distance(t[i], t[(i + 1) % 3]);
    if (length > longest.length) longest = {i, length};
  }
  return longest;
}

std::array<Triangle, 2> bisect(const Triangle& t, int from) {
  const Vec3 &a = t[from], &b = t[(from + 1) % 3], &c = t[(from + 2) % 3], middle = 0.5 * (a + b);
  return {{{a, middle, c}, {middle, b, c}}};
}

ShearedLine::ShearedLine(Vec3 point, Vec3 direction) : _point(point) {
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  _axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  _first = (_axis + 1) % 3;
  _second = (_axis + 2) % 3;
  _scale = 1 / direction[_axis];
  _shear = _scale * Vec2{direction[_first], direction[_second]};
}

double ShearedLine::place_of(const Triangle& t) const {
  constexpr double missed = std::numeric_limits<double>::infinity();
  const std::array corners{sheared(t[0]), sheared(t[1]), sheared(t[2])};
  std::array<double, 3> weights;
  bool left = false, right = false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &from = corners[(i + 1) % 3], &to = corners[(i + 2) % 3];
    weights[i] = from.x * to.y - from.y * to.x;
    // Rounding is monotone: the difference of two products has the right sign or none.
    const int side =
        weights[i] != 0 ? (weights[i] > 0 ? 1 : -1) : orient2d({0, 0}, {from.x, from.y}, {to.x, to.y});
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left == right) return missed;
  const double sum = weights[0] + weights[1] + weights[2];
  // Where all weights are rounded to nothing the triangle is next to a line itself.
  const double place =
      sum != 0 ? (weights[0] * corners[0].z + weights[1] * corners[1].z + weights[2] * corners[2].z) / sum
               : (corners[0].z + corners[1].z + corners[2].z) / 3;
  return place != 0 ? place : missed;
}

TriangleTree::TriangleTree(const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  std::vector<std::int32_t> of_boxes, numbers;
  boxes.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    add_boxes(triangles[t], boxes);
    const std::size_t parts = boxes.size() - of_boxes.size();
    of_boxes.resize(boxes.size(), static_cast<std::int32_t>(t));
    numbers.resize(boxes.size(), parts == 1 ? in_one_box : static_cast<std::int32_t>(t));
  }
  _tree = geometry::BoxTree(boxes, triangles_per_leaf);
  _triangles.reserve(boxes.size());
  _numbers.reserve(boxes.size());
  _boxes.reserve(boxes.size());
  _normals.reserve(boxes.size());
  for (const std::int32_t box : _tree.order()) {
    const Triangle& t = triangles[of_boxes[box]];
    _triangles.push_back(t);
    _numbers.push_back(numbers[box]);
    _normals.push_back(cross(t[1] - t[0], t[2] - t[0]));
    _boxes.push_back(boxes[box]);
  }
}

bool TriangleTree::overlaps_inside(std::int32_t triangle, Vec3 low, double edge) const {
  if (!boxes_overlap_inside(_boxes[triangle], low, edge)) return false;
  // The plane passes through the open cube.
  const Vec3 normal = _normals[triangle], center = low + 0.5 * edge * Vec3{1, 1, 1};
  const double reach = 0.5 * edge * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  return std::abs(dot(normal, center - _triangles[triangle][0])) < reach;
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
  constexpr double missed = std::numeric_limits<double>::infinity();
  const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  const ShearedLine line(point, direction);
  bool odd = false;
  std::vector<std::int32_t> crossed;  // of those in several boxes, each of which may be met
  _tree.search([&](const Box& box) { return entry(box, point, inverse) < missed; },
               [&](std::int32_t place) {
                 const double along = line.place_of(_triangles[place]);
                 if (!(along > 0 && along < missed)) return;
                 if (_numbers[place] == in_one_box)
                   odd = !odd;
                 else
                   crossed.push_back(_numbers[place]);
               });
  std::sort(crossed.begin(), crossed.end());
  const auto once = std::unique(crossed.begin(), crossed.end()) - crossed.begin();
  return odd != (once % 2 == 1);
}

bool TriangleTree::contains(Vec3 point) const {
  // No direction is likely to run along facets.
  const bool first = odd_crossings(point, {0.8191, 0.4271, 0.3829});
  const bool second = odd_crossings(point, {-0.3137, 0.7873, -0.5308});
  return first == second ? first : odd_crossings(point, {0.2719, -0.6133, -0.7416});
}

double TriangleTree::fraction_behind(Vec3 low, double edge, std::span<const std::int32_t> triangles) const {
  const Vec3 middle = low + 0.5 * edge * Vec3{1, 1, 1};
  double nearest = 1e300, side = 0;
  Vec3 direction;
  for (const std::int32_t i : triangles) {
    const Triangle& t = _triangles[i];
    // No triangle is nearer than its plane.
    const double over = dot(_normals[i], middle - t[0]);
    if (over * over > nearest * (1 + not_less) * dot(_normals[i], _normals[i])) continue;
    const double square = squared_distance(middle, t, _normals[i]);
    if (square > nearest * (1 + equal)) continue;
    const Vec3 normal = geometry::normalized(_normals[i]);
    const double height = dot(normal, middle - t[0]);
    // Where two facets meet at the nearest place, the one seen more directly tells the side.
    const bool tie = square >= nearest * (1 - equal);
    if (!tie || std::abs(height) > std::abs(side)) side = height, direction = normal;
    nearest = std::min(nearest, square);
  }
  // A facet that is seen past its border is farther away than its plane.
  const double away = std::copysign(std::sqrt(nearest), side);
  const double width = edge * (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  return std::clamp(0.5 - away / std::max(width, least_length), 0.0, 1.0);
}

}  // namespace aeroloom::sizing
