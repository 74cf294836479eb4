#include "sizing/seed_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::sizing {
namespace {

static_assert(grid_size <= 1U << 24, "coordinates must be exact in single precision");

double squared_distance(const std::array<float, 3>& low, const std::array<float, 3>& high, double x, double y,
                        double z) {
  const double dx = std::max({0.0, low[0] - x, x - high[0]});
  const double dy = std::max({0.0, low[1] - y, y - high[1]});
  const double dz = std::max({0.0, low[2] - z, z - high[2]});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

SeedTree::SeedTree(std::vector<SizeSeed> seeds, double slope) : _slope(slope), _steps_per_size(1 / slope) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) order.emplace_back(morton_key(seeds[i].low), i);
  std::sort(order.begin(), order.end());
  std::vector<Group>& single = _levels.emplace_back();
  single.reserve(seeds.size());
  for (const auto& [key, i] : order) {
    const SizeSeed& s = seeds[i];
    const auto at = [](std::uint32_t coordinate) { return static_cast<float>(coordinate); };
    single.push_back({{at(s.low.x), at(s.low.y), at(s.low.z)},
                      {at(s.low.x + s.edge), at(s.low.y + s.edge), at(s.low.z + s.edge)},
                      s.size});
  }
  seeds = {}, order = {};
  while (_levels.back().size() > group) {
    const std::vector<Group>& below = _levels.back();
    std::vector<Group> above;
    above.reserve(below.size() / group + 1);
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % group == 0) {
        above.push_back(below[i]);
        continue;
      }
      Group& joint = above.back();
      for (int axis = 0; axis < 3; ++axis) {
        joint.low[axis] = std::min(joint.low[axis], below[i].low[axis]);
        joint.high[axis] = std::max(joint.high[axis], below[i].high[axis]);
      }
      joint.size = std::min(joint.size, below[i].size);
    }
    _levels.push_back(std::move(above));
  }
}

double SeedTree::offer(std::size_t seed, const Point& p) const {
  const Group& s = _levels.front()[seed];
  return s.size + _slope * std::sqrt(squared_distance(s.low, s.high, p.x, p.y, p.z));
}

bool SeedTree::may_offer_less(const Group& of, const Point& p, double best) const {
  constexpr double rounding = 1 + 1e-9;
  const double within = (best - of.size) * _steps_per_size * rounding;
  return within > 0 && squared_distance(of.low, of.high, p.x, p.y, p.z) < within * within;
}

template <bool any>
bool SeedTree::search(std::size_t level, std::size_t first, std::size_t last, const Point& p,
                      Best& best) const {
  const std::vector<Group>& groups = _levels[level];
  for (std::size_t i = first; i < last; ++i) {
    if (!may_offer_less(groups[i], p, best.size)) continue;
    if (level > 0) {
      const std::size_t end = std::min((i + 1) * group, _levels[level - 1].size());
      if (search<any>(level - 1, i * group, end, p, best)) return true;
      continue;
    }
    const double size = offer(i, p);
    if (size >= best.size) continue;
    best = {size, static_cast<std::int32_t>(i)};
    if (any) return true;
  }
  return false;
}

double SeedTree::cheapest(GridPoint p, double bound, std::int32_t& near) const {
  if (_levels.empty()) return bound;
  const Point at{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  Best best{bound, -1};
  if (near >= 0) {
    const double size = offer(static_cast<std::size_t>(near), at);
    if (size < best.size) best = {size, near};
  }
  search<false>(_levels.size() - 1, 0, _levels.back().size(), at, best);
  near = best.seed;
  return best.size;
}

bool SeedTree::offers_less(GridPoint p, double bound) const {
  if (_levels.empty()) return false;
  const Point at{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  Best best{bound, -1};
  return search<true>(_levels.size() - 1, 0, _levels.back().size(), at, best);
}

}  // namespace aeroloom::sizing
