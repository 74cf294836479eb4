#include "sizing/field/source_tree.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace aeroloom::sizing {
namespace {

constexpr int sources_per_leaf = 8;  // chosen, not measured
// What rounding may make of a bound, with some to spare: no source that may win is left out.
constexpr double below_rounding = 1 - 1e-12;

double distance_to_box(const geometry::Box& box, geometry::Vec3 point) {
  geometry::Vec3 off;
  for (int axis = 0; axis < 3; ++axis)
    off[axis] = std::max({box.low[axis] - point[axis], point[axis] - box.high[axis], 0.0});
  return norm(off);
}

}  // namespace

SourceTree::SourceTree(std::span<const SizeSource> sources, double slope) : _slope(slope) {
  std::map<int, std::vector<SizeSource>> by_size;  // by powers of two
  for (const SizeSource& source : sources) by_size[std::ilogb(source.size)].push_back(source);
  for (auto& [power, own] : by_size) {
    Group& group = _groups.emplace_back();
    std::vector<geometry::Box> boxes(own.size());
    group.smallest = own.front().size;
    for (std::size_t i = 0; i < own.size(); ++i) {
      boxes[i].add(own[i].point);
      group.smallest = std::min(group.smallest, own[i].size);
    }
    group.tree = geometry::BoxTree(boxes, sources_per_leaf);
    group.sources.reserve(own.size());
    for (const std::int32_t i : group.tree.order()) group.sources.push_back(own[static_cast<std::size_t>(i)]);
  }
}

double SourceTree::least(geometry::Vec3 point, double most) const {
  double least = most;
  for (const Group& group : _groups) {
    if (!(group.smallest < least)) break;
    const auto at_least = [&](const geometry::Box& box) {
      return below_rounding * (group.smallest + _slope * distance_to_box(box, point));
    };
    group.tree.search_nearest(at_least, least, [&](std::int32_t place) {
      const SizeSource& source = group.sources[static_cast<std::size_t>(place)];
      least = std::min(least, source.size + _slope * distance(source.point, point));
    });
  }
  return least;
}

}  // namespace aeroloom::sizing
