#include "sizing/seed_tree.hpp"

#include "geometry/sort_by_key.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace aeroloom::sizing {
namespace {

static_assert(grid_size <= 1U << 24, "coordinates must be exact in single precision");

/// Not above the value.
float round_down(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

}  // namespace

SeedTree::SeedTree(std::vector<SizeSeed> seeds, double slope) : _slope(slope), _steps_per_size(1 / slope) {
  if (seeds.empty()) return;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) order.emplace_back(morton_key(seeds[i].low), i);
  geometry::sort_by_key(order, [](const auto& each) { return each.first; });
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Group empty;
  empty.size.fill(infinity);
  for (int axis = 0; axis < 3; ++axis) empty.low[axis].fill(infinity), empty.high[axis].fill(-infinity);
  const auto groups_for = [&](std::size_t count) {
    return std::vector<Group>((count + group - 1) / group, empty);
  };
  std::vector<Group>& lowest = _levels.emplace_back(groups_for(seeds.size()));
  _sizes.reserve(seeds.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const SizeSeed& s = seeds[order[i].second];
    const std::array<std::uint32_t, 3> low{s.low.x, s.low.y, s.low.z};
    Group& to = lowest[i / group];
    for (int axis = 0; axis < 3; ++axis) {
      to.low[axis][i % group] = static_cast<float>(low[axis]);
      to.high[axis][i % group] = static_cast<float>(low[axis] + s.edge);
    }
    to.size[i % group] = round_down(s.size);
    _sizes.push_back(s.size);
  }
  while (_levels.back().size() > 1) {
    const std::vector<Group>& below = _levels.back();
    std::vector<Group> above = groups_for(below.size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      Group& to = above[i / group];
      const Group& from = below[i];
      for (int axis = 0; axis < 3; ++axis) {
        to.low[axis][i % group] = *std::min_element(from.low[axis].begin(), from.low[axis].end());
        to.high[axis][i % group] = *std::max_element(from.high[axis].begin(), from.high[axis].end());
      }
      to.size[i % group] = *std::min_element(from.size.begin(), from.size.end());
    }
    _levels.push_back(std::move(above));
  }
}

double SeedTree::offer(std::size_t seed, const Point& p) const {
  const Group& in = _levels.front()[seed / group];
  const std::size_t i = seed % group;
  const auto outside = [&](int axis, double at) {
    return std::max({0.0, in.low[axis][i] - at, at - in.high[axis][i]});
  };
  const double dx = outside(0, p.x), dy = outside(1, p.y), dz = outside(2, p.z);
  return _sizes[seed] + _slope * std::sqrt(dx * dx + dy * dy + dz * dz);
}

template <bool any>
bool SeedTree::search(std::size_t level, std::size_t number, const Point& p, Best& best) const {
  // More than single precision can be wrong by.
  constexpr float rounding = 1 + 1e-5F;
  const Group& from = _levels[level][number];
  std::array<float, group> squares;
  for (int i = 0; i < group; ++i) {
    const float dx = std::max(std::max(0.0F, from.low[0][i] - p.x), p.x - from.high[0][i]);
    const float dy = std::max(std::max(0.0F, from.low[1][i] - p.y), p.y - from.high[1][i]);
    const float dz = std::max(std::max(0.0F, from.low[2][i] - p.z), p.z - from.high[2][i]);
    squares[i] = dx * dx + dy * dy + dz * dz;
  }
  for (int i = 0; i < group; ++i) {
    const auto within = static_cast<float>((best.size - from.size[i]) * _steps_per_size) * rounding;
    if (!(within > 0 && squares[i] < within * within)) continue;
    const std::size_t below = number * group + static_cast<std::size_t>(i);
    if (level > 0) {
      if (search<any>(level - 1, below, p, best)) return true;
      continue;
    }
    const double size = offer(below, p);
    if (size >= best.size) continue;
    best = {size, static_cast<std::int32_t>(below)};
    if (any) return true;
  }
  return false;
}

double SeedTree::cheapest(GridPoint p, double bound, std::int32_t& near) const {
  if (_levels.empty()) return bound;
  const Point at = point(p);
  Best best{bound, -1};
  if (near >= 0) {
    const double size = offer(static_cast<std::size_t>(near), at);
    if (size < best.size) best = {size, near};
  }
  search<false>(_levels.size() - 1, 0, at, best);
  near = best.seed;
  return best.size;
}

bool SeedTree::offers_less(GridPoint p, double bound) const {
  if (_levels.empty()) return false;
  Best best{bound, -1};
  return search<true>(_levels.size() - 1, 0, point(p), best);
}

}  // namespace aeroloom::sizing
