#include "sizing/features/ray_tree.hpp"

#include "geometry/sort_unique.hpp"

#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace aeroloom::sizing {
namespace {

using geometry::Box;
using geometry::Vec3;
using Frame = std::array<Vec3, 3>;

// Numbers of this file were chosen, not measured one by one; the bundle of pipes that they are for is
// measured in benchmarks/results/many_faces.md.

constexpr std::int32_t boxes_per_leaf = 4;
// Areas of the sides of a box over the area of the triangle in it, from which on it is cut, at most so often;
// and boxes for each triangle, at most, on average.
constexpr double least_emptiness = 16, most_emptiness = 1e6;
constexpr int most_cuts = 6;
constexpr std::size_t boxes_per_triangle = 3;
constexpr double rounding =
    1e-12;  // of the extent, by which boxes are wider: corners turned into a frame err by less
// Groups of about one direction, at most; how many slender triangles make one; the cosine of what their
// directions differ by, about two degrees.
constexpr std::size_t most_groups = 16, least_group = 256;
constexpr double same_direction = 0.9994;
// Directions are counted in cells of a grid of this edge around the sphere, about twice that: one that counts
// has a cell with so many triangles, and this part of the sides of all boxes. Every other direction costs
// each ray more than it saves.
constexpr double cell_of_directions = 0.07, least_part = 0.02;
constexpr std::size_t least_in_cell = least_group / 4;
// Triangles join a group where the sides of their boxes are this part of what they are along the axes.
constexpr double far_smaller = 0.5;

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

/// Calls `visit` for the boxes of the parts of a triangle.
template <class Visit>
void for_each_box(const Triangle& t, double emptiness, int cuts, const Visit& visit) {
  const Box box = box_around(t);
  const double area = area_of(t);
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

/// A triangle that is slender.
struct Slender {
  std::int32_t triangle;
  double sides;  ///< of its box
  Vec3 direction;
  std::int32_t cell = 0;  ///< of directions
};

/// Numbers the cells of a grid of directions, opposite ones being the same, that slender triangles have.
std::int32_t number_cells(std::vector<Slender>& slender) {
  std::map<std::array<int, 3>, std::int32_t> numbers;
  for (Slender& each : slender) {
    Vec3 d = each.direction;
    if (std::tie(d.x, d.y, d.z) < std::tuple(0.0, 0.0, 0.0)) d = -1 * d;
    const auto step = [](double x) { return static_cast<int>(std::floor(x / cell_of_directions)); };
    const auto next = static_cast<std::int32_t>(numbers.size());
    each.cell = numbers.try_emplace({step(d.x), step(d.y), step(d.z)}, next).first->second;
  }
  return static_cast<std::int32_t>(numbers.size());
}

struct Direction {
  Vec3 along;
  std::size_t count = 0;  ///< of triangles along it
};

/// The direction in the cell with the largest boxes in all, of those whose sides add up to enough; takes away
/// what is along it. None: a count of nothing.
Direction take_direction(std::vector<Slender>& slender, std::int32_t cells, double least_sides) {
  struct Cell {
    double sides = 0;
    std::size_t count = 0;
    const Slender* largest = nullptr;
  };
  std::vector<Cell> all(cells);
  for (const Slender& each : slender) {
    Cell& cell = all[each.cell];
    if (cell.largest == nullptr || each.sides > cell.largest->sides) cell.largest = &each;
    cell.sides += each.sides, ++cell.count;
  }
  const Cell* best = nullptr;
  for (const Cell& cell : all) {
    if (cell.count >= least_in_cell && cell.sides >= least_sides &&
        (best == nullptr || cell.sides > best->sides))
      best = &cell;
  }
  if (best == nullptr) return {};
  const Vec3 along = best->largest->direction;
  const auto count = std::erase_if(
      slender, [&](const Slender& each) { return std::abs(dot(each.direction, along)) >= same_direction; });
  return {along, count};
}

}  // namespace

RayTree::RayTree(std::span<const Triangle> triangles) {
  std::vector<Slender> left;
  double all_sides = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double area = area_of(triangles[t]), sides = sides_of(box_around(triangles[t]));
    all_sides += sides;
    if (area > 0 && sides > least_emptiness * area)
      left.push_back({static_cast<std::int32_t>(t), sides, direction_of(triangles[t])});
  }
  std::vector<Frame> frames;
  const std::int32_t cells = number_cells(left);
  for (std::size_t i = 0; i < most_groups && left.size() >= least_group; ++i) {
    const Direction direction = take_direction(left, cells, least_part * all_sides);
    if (direction.count == 0) break;
    if (direction.count >= least_group) frames.push_back(frame_along(direction.along));
  }
  // A triangle that lies across a direction is flat in its frame, whose boxes then do it no good.
  std::vector<std::vector<std::int32_t>> members(frames.size());
  std::vector<std::int32_t> others;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    double least = far_smaller * sides_of(box_around(triangles[t]));
    std::vector<std::int32_t>* to = &others;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double sides = sides_of(box_around(turned(frames[i], triangles[t])));
      if (sides < least) least = sides, to = &members[i];
    }
    to->push_back(static_cast<std::int32_t>(t));
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!members[i].empty()) add_group(triangles, members[i], frames[i]);
  }
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
  geometry::sort_unique(found);
}

}  // namespace aeroloom::sizing
