#include "sizing/field/seed_tree.hpp"

#include "geometry/sort_by_key.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace aeroloom::sizing {
namespace {

static_assert(grid_size <= 1U << 24, "coordinates must be exact in single precision");

/// Levels of groups that ranks make of their own seeds: what is above has hundreds of seeds in each. Chosen,
/// not measured.
constexpr std::size_t levels_of_ranks = 3;

/// Not above the value.
float round_down(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

/// Calls visit(first, last) for parts of four to eight neighbours along the curve, cut where it leaves the
/// largest cubes: boxes of parts on both sides of one would be far larger.
template <class Visit>
void part_by_boundaries(const std::vector<std::uint64_t>& keys, const Visit& visit) {
  constexpr std::size_t most = 8, least = 4;  // seeds; chosen, not measured
  const auto boundary = [&](std::size_t i) { return std::bit_width(keys[i] ^ keys[i - 1]); };
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    last = std::min(first + most, keys.size());
    if (last < keys.size()) {
      for (std::size_t cut = last; cut-- > first + least;)
        if (boundary(cut) > boundary(last)) last = cut;
    }
    visit(first, last);
  }
}

}  // namespace

/// Groups of one level, and the keys that they begin with.
struct SeedTree::Layer {
  std::vector<Group> groups;
  std::vector<std::uint64_t> keys;
};

SharedSeeds::SharedSeeds(const Subtrees& subtrees, const std::vector<SizeSeed>& own)
    : _communicator(subtrees.communicator()), _firsts{0} {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> levels;
  std::vector<double> sizes;
  parallel::agree(_communicator, [&] {
    for (const SizeSeed& seed : own) {
      keys.push_back(morton_key(seed.low)), sizes.push_back(seed.size);
      const int level = std::bit_width(grid_size) - std::bit_width(seed.edge);
      levels.push_back(seed.edge == 0 ? of_point : static_cast<std::uint8_t>(level));
    }
  });
  for (const auto count : _communicator.all_gather_values(static_cast<std::uint64_t>(own.size())))
    _firsts.push_back(_firsts.back() + count);
  _keys = parallel::NodeArray<std::uint64_t>::gathered(_communicator, std::move(keys));
  _levels = parallel::NodeArray<std::uint8_t>::gathered(_communicator, std::move(levels));
  _sizes = parallel::NodeArray<double>::gathered(_communicator, std::move(sizes));
}

void SharedSeeds::append(parallel::Rank rank, std::vector<Keyed>& seeds) const {
  for (std::size_t i = _firsts[rank]; i < _firsts[rank + 1]; ++i) {
    const std::uint32_t edge = _levels[i] == of_point ? 0 : grid_size >> _levels[i];
    seeds.push_back({_keys[i], {grid_point(_keys[i]), edge, _sizes[i]}});
  }
}

SeedTree::Layer SeedTree::lowest_layer(const std::vector<SharedSeeds::Keyed>& seeds) {
  std::vector<std::uint64_t> keys;
  keys.reserve(seeds.size());
  for (const auto& [key, seed] : seeds) keys.push_back(key);
  Layer layer;
  part_by_boundaries(keys, [&](std::size_t first, std::size_t last) {
    Group& to = layer.groups.emplace_back(first);
    for (std::size_t i = first; i < last; ++i) to.put(i - first, seeds[i].seed);
    layer.keys.push_back(keys[first]);
  });
  return layer;
}

SeedTree::Layer SeedTree::layer_above(const Layer& below) {
  Layer layer;
  part_by_boundaries(below.keys, [&](std::size_t first, std::size_t last) {
    Group& to = layer.groups.emplace_back(first);
    for (std::size_t i = first; i < last; ++i) to.put(i - first, below.groups[i]);
    layer.keys.push_back(below.keys[first]);
  });
  return layer;
}

/// What there is of a tree for the seeds of one rank: their sizes along the curve, and the lowest levels.
struct SeedTree::PartOfRank {
  std::vector<double> sizes;
  std::vector<Layer> layers;

  PartOfRank() = default;
  PartOfRank(std::span<const SharedSeeds* const> lists, parallel::Rank rank) {
    std::vector<SharedSeeds::Keyed> seeds;
    for (const SharedSeeds* list : lists) list->append(rank, seeds);
    geometry::sort_by_key(seeds, [](const SharedSeeds::Keyed& each) { return each.key; });
    for (const auto& [key, seed] : seeds) sizes.push_back(seed.size);
    layers.push_back(lowest_layer(seeds));
    while (layers.size() < levels_of_ranks) layers.push_back(layer_above(layers.back()));
  }
  /// The groups of a level, where the first of their members has this number among all.
  std::vector<Group> numbered(std::size_t level, std::size_t first_below) const {
    std::vector<Group> groups = layers[level].groups;
    for (Group& each : groups) each.first += static_cast<std::uint32_t>(first_below);
    return groups;
  }
};

// Seeds travel. The tree does not: the parts of ranks of other nodes are made once more on each node.
SeedTree::SeedTree(std::initializer_list<const SharedSeeds*> lists, double slope)
    : _slope(slope), _steps_per_size(1 / slope) {
  const parallel::Communicator& communicator = (*lists.begin())->communicator();
  std::map<parallel::Rank, PartOfRank> parts;
  const auto part_of = [&](parallel::Rank rank) -> const PartOfRank& {
    const auto known = parts.find(rank);
    return known != parts.end() ? known->second : parts.emplace(rank, PartOfRank(lists, rank)).first->second;
  };
  const parallel::Rank me = communicator.rank();
  parallel::agree(communicator, [&] { part_of(me); });
  // Of each rank the first number among the items that the level being made is made of.
  std::vector<std::size_t> firsts;
  const auto note_firsts = [&](std::size_t own) {
    std::size_t before = 0;
    firsts.clear();
    for (const auto count : communicator.all_gather_values(static_cast<std::uint64_t>(own)))
      firsts.push_back(std::exchange(before, before + count));
  };
  const auto write_sizes = [&](parallel::Rank rank, std::size_t, std::span<double> to) {
    std::copy(part_of(rank).sizes.begin(), part_of(rank).sizes.end(), to.begin());
  };
  note_firsts(part_of(me).sizes.size());
  _sizes = parallel::NodeArray<double>::composed(communicator, part_of(me).sizes, write_sizes);
  for (std::size_t level = 0; level < levels_of_ranks; ++level) {
    const auto write = [&](parallel::Rank rank, std::size_t, std::span<Group> to) {
      const std::vector<Group> theirs = part_of(rank).numbered(level, firsts[static_cast<std::size_t>(rank)]);
      std::copy(theirs.begin(), theirs.end(), to.begin());
    };
    std::vector<Group> mine = part_of(me).numbered(level, firsts[static_cast<std::size_t>(me)]);
    const std::size_t count = mine.size();
    _levels.push_back(parallel::NodeArray<Group>::composed(communicator, std::move(mine), write));
    note_firsts(count);
  }
  // The levels above are small, and every rank makes them.
  const std::span<const Group> last = _levels.back().items();
  Layer above{{last.begin(), last.end()},
              communicator.all_gather_items<std::uint64_t>(part_of(me).layers.back().keys)};
  while (above.groups.size() > 1) {
    above = layer_above(above);
    _levels.emplace_back(above.groups);
  }
  if (above.groups.empty()) _levels.clear();
}

SeedGroup::SeedGroup(std::size_t number) : first(static_cast<std::uint32_t>(number)) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  size.fill(infinity);
  for (int axis = 0; axis < 3; ++axis) low[axis].fill(infinity), high[axis].fill(-infinity);
}

void SeedGroup::put(std::size_t i, const SizeSeed& seed) {
  const std::array<std::uint32_t, 3> from{seed.low.x, seed.low.y, seed.low.z};
  for (int axis = 0; axis < 3; ++axis) {
    low[axis][i] = static_cast<float>(from[axis]);
    high[axis][i] = static_cast<float>(from[axis] + seed.edge);
  }
  size[i] = round_down(seed.size);
}

void SeedGroup::put(std::size_t i, const SeedGroup& below) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis][i] = *std::min_element(below.low[axis].begin(), below.low[axis].end());
    high[axis][i] = *std::max_element(below.high[axis].begin(), below.high[axis].end());
  }
  size[i] = *std::min_element(below.size.begin(), below.size.end());
}

double SeedTree::offer(std::size_t seed, const Point& p) const {
  const Group& in = _levels.front()[seed / group];
  const std::size_t i = seed % group;
  const auto outside = [&](int axis, double at) {
    return std::max({0.0, in.low[axis][i] - at, at - in.high[axis][i]});
  };
  const double dx = outside(0, p.x), dy = outside(1, p.y), dz = outside(2, p.z);
  return _sizes[in.first + i] + _slope * std::sqrt(dx * dx + dy * dy + dz * dz);
}

template <bool any>
bool SeedTree::search(std::size_t level, std::size_t number, const Point& p, Best& best) const {
  // More than single precision can be wrong by.
  constexpr float rounding = 1 + 1e-5F;
  const Group& from = _levels[level][number];
  std::array<float, group> squares, margins;
  for (int i = 0; i < group; ++i) {
    const float dx = std::max(std::max(0.0F, from.low[0][i] - p.x), p.x - from.high[0][i]);
    const float dy = std::max(std::max(0.0F, from.low[1][i] - p.y), p.y - from.high[1][i]);
    const float dz = std::max(std::max(0.0F, from.low[2][i] - p.z), p.z - from.high[2][i]);
    squares[i] = dx * dx + dy * dy + dz * dz;
  }
  const auto steps_per_size = static_cast<float>(_steps_per_size);
  auto limit = static_cast<float>(best.size) * rounding;
  const auto reach = [&](int i) {
    return std::max(0.0F, (limit - from.size[i]) * steps_per_size * rounding);
  };
  for (int i = 0; i < group; ++i) margins[i] = reach(i) * reach(i) - squares[i];
  const auto visit = [&](int i) {
    if (level > 0) {
      const bool found = search<any>(level - 1, from.first + static_cast<std::size_t>(i), p, best);
      limit = static_cast<float>(best.size) * rounding;
      return found;
    }
    const std::size_t seed = number * group + static_cast<std::size_t>(i);
    const double size = offer(seed, p);
    if (size >= best.size) return false;
    best = {size, static_cast<std::int32_t>(seed)};
    limit = static_cast<float>(size) * rounding;
    return any;
  };
  // The most promising one first: most others are not looked at then.
  const int first = static_cast<int>(std::max_element(margins.begin(), margins.end()) - margins.begin());
  if (!(margins[first] > 0)) return false;
  if (visit(first)) return true;
  for (int i = 0; i < group; ++i) {
    if (i != first && margins[i] > 0 && squares[i] < reach(i) * reach(i) && visit(i)) return true;
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
