#include "sizing/ray_tree.hpp"

#include <limits>
#include <numeric>

namespace aeroloom::sizing {
namespace {

using geometry::Box;
using geometry::Vec3;
using Frame = std::array<Vec3, 3>;

constexpr std::int32_t boxes_per_leaf = 4;
// Areas of the sides of a box over the area of the triangle in it, from which on it is cut, at most so often;
// and boxes for each triangle, at most, on average.
constexpr double least_emptiness = 16, most_emptiness = 1e6;
constexpr int most_cuts = 6;
constexpr std::size_t boxes_per_triangle = 3;
constexpr double rounding = 1e-12;  // of the extent, by which boxes are wider
// Groups of slender triangles, at most; how many make one; the cosine of what their directions differ by,
// about two degrees.
constexpr std::size_t most_groups = 16, least_group = 256;
constexpr double same_direction = 0.9994;

constexpr Frame unturned{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

Vec3 turned(const Frame& frame, Vec3 p) {
  return {dot(frame[0], p), dot(frame[1], p), dot(frame[2], p)};
}

Triangle turned(const Frame& frame, const Triangle& t) {
  return {turned(frame, t[0]), turned(frame, t[1]), turned(frame, t[2])};
}

Box box_around(const Triangle& t) {
  Box box;
  for (const Vec3 p : t) box.add(p);
  return box;
}

double sides_of(const Box& box) {
  const Vec3 size = box.size();
  return 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

double area_of_triangle(const Triangle& t) {
  return 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
}

/// Calls `visit` for the boxes of the parts of a triangle.
template <class Visit>
void for_each_box(const Triangle& t, double emptiness, int cuts, const Visit& visit) {
  const Box box = box_around(t);
  const double area = area_of_triangle(t);
  if (cuts == 0 || !(area > 0) || sides_of(box) <= emptiness * area) return visit(box);
  for (const Triangle& half : bisect(t, longest_edge(t).from)) for_each_box(half, emptiness, cuts - 1, visit);
}

/// How empty boxes may be for there not to be too many.
double find_emptiness(std::span<const Triangle> all, std::span<const std::int32_t> members,
                      const Frame& frame) {
  for (double emptiness = least_emptiness; emptiness < most_emptiness; emptiness *= 2) {
    std::size_t count = 0;
    for (const std::int32_t t : members)
      for_each_box(turned(frame, all[t]), emptiness, most_cuts, [&](const Box&) { ++count; });
    if (count <= boxes_per_triangle * members.size()) return emptiness;
  }
  return std::numeric_limits<double>::infinity();
}

Vec3 direction_of(const Triangle& t) {
  const int from = longest_edge(t).from;
  return normalized(t[(from + 1) % 3] - t[from]);
}

Frame frame_along(Vec3 axis) {
  const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
  const Vec3 other = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 second = normalized(cross(axis, other));
  return {axis, second, cross(axis, second)};
}

/// Takes those of about the same direction as the slender triangle with the largest box out of `slender`.
std::vector<std::int32_t> take_group(std::span<const Triangle> all, std::vector<std::int32_t>& slender,
                                     Vec3& direction) {
  const auto largest = std::max_element(slender.begin(), slender.end(), [&](std::int32_t a, std::int32_t b) {
    return sides_of(box_around(all[a])) < sides_of(box_around(all[b]));
  });
  direction = direction_of(all[*largest]);
  std::vector<std::int32_t> group, rest;
  for (const std::int32_t t : slender)
    (std::abs(dot(direction_of(all[t]), direction)) >= same_direction ? group : rest).push_back(t);
  slender = std::move(rest);
  return group;
}

}  // namespace

RayTree::RayTree(std::span<const Triangle> triangles) {
  std::vector<std::int32_t> slender, others;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double area = area_of_triangle(triangles[t]);
    const bool is_slender = area > 0 && sides_of(box_around(triangles[t])) > least_emptiness * area;
    (is_slender ? slender : others).push_back(static_cast<std::int32_t>(t));
  }
  for (std::size_t i = 0; i < most_groups && slender.size() >= least_group; ++i) {
    Vec3 direction;
    const std::vector<std::int32_t> group = take_group(triangles, slender, direction);
    if (group.size() < least_group) {
      others.insert(others.end(), group.begin(), group.end());
    } else {
      add_group(triangles, group, frame_along(direction));
    }
  }
  others.insert(others.end(), slender.begin(), slender.end());
  std::sort(others.begin(), others.end());
  if (!others.empty()) add_group(triangles, others, unturned);
}

void RayTree::add_group(std::span<const Triangle> all, std::span<const std::int32_t> members,
                        const Frame& frame) {
  Group& group = _groups.emplace_back();
  group.frame = frame;
  group.emptiness = find_emptiness(all, members, frame);
  std::vector<Box> boxes;
  Box around;
  for (const std::int32_t t : members) {
    for_each_box(turned(frame, all[t]), group.emptiness, most_cuts, [&](const Box& box) {
      boxes.push_back(box);
      around.add(box);
      group.triangles.push_back(t);
    });
  }
  const double wider = rounding * (around.diagonal() + norm(around.center()));
  for (Box& box : boxes) box = box.dilated(wider);
  group.tree = geometry::BoxTree(boxes, boxes_per_leaf);
}

void RayTree::find_near(const Triangle& triangle, double within,
                        const std::function<bool(std::int32_t)>& counts, std::vector<std::int32_t>& found,
                        std::int64_t& nodes) const {
  found.clear();
  for (const Group& group : _groups) {
    for_each_box(turned(group.frame, triangle), group.emptiness, most_cuts, [&](const Box& box) {
      const Box around = box.dilated(within);
      group.tree.search(
          [&](const Box& node) {
            ++nodes;
            return node.overlaps(around);
          },
          [&](std::int32_t place) {
            const std::int32_t near = group.triangles[group.tree.order()[place]];
            if (counts(near)) found.push_back(near);
          });
    });
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace aeroloom::sizing
