// Which cells of an octree are split.
#include "geometry/sort_by_key.hpp"
#include "parallel/communication/deliver.hpp"
#include "sizing/field/octree.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::sizing {
namespace {

void keep_each_key_once(std::vector<std::uint64_t>& keys) {
  geometry::sort_by_key(keys, [](std::uint64_t key) { return key; });
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// For each child of a cell, which of the 27 cells around the parent, it included, the child touches: bit
/// x + 3 y + 9 z.
constexpr std::array<std::uint32_t, 8> around_child = [] {
  std::array<std::uint32_t, 8> touched{};
  for (int child = 0; child < 8; ++child) {
    for (int side = 0; side < 8; ++side) {
      const auto step = [&](int axis) {
        const bool high = (child >> axis & 1) != 0, beside = (side >> axis & 1) != 0;
        return beside ? (high ? 2 : 0) : 1;
      };
      touched[child] |= 1U << (step(0) + 3 * step(1) + 9 * step(2));
    }
  }
  return touched;
}();

/// Calls visit(parent, wanted) for the parents of cells along the curve. Siblings share most of the cells
/// around their parent: each is asked for once, by its place among the 27.
template <class Visit>
void for_each_parent(const std::vector<std::uint64_t>& cells, const Visit& visit) {
  for (std::size_t i = 0; i < cells.size();) {
    const std::uint64_t parent = cells[i] >> 3;
    std::uint32_t wanted = 0;
    for (; i < cells.size() && cells[i] >> 3 == parent; ++i) wanted |= around_child[cells[i] & 7];
    visit(parent, wanted);
  }
}

}  // namespace

SplitCubes::SplitCubes(Subtrees subtrees) : _subtrees(std::move(subtrees)) {
  for (std::size_t subtree = 0; subtree < _subtrees.count(); ++subtree) {
    for (int level = _subtrees.level(subtree) - 1; level >= 0; --level) {
      const std::uint64_t cell = _subtrees.key(subtree) >> 3 * (finest_level - level);
      // Subtrees come along the curve, so cells above them do.
      if (!_above[level].empty() && _above[level].back() == cell) break;
      _above[level].push_back(cell);
    }
  }
}

// A split cell needs neighbours of its own level: their parents, itself included, must be split.
void SplitCubes::split_around(std::uint64_t parent, int level, std::uint32_t wanted) {
  const std::uint32_t range = 1U << level;
  const int below = 3 * (finest_level - level);
  const GridPoint c = grid_point(parent);
  const std::size_t home = _subtrees.find(parent << below);
  const int to_subtree = 3 * (level - _subtrees.level(home));
  const bool is_at_home = to_subtree >= 0 && _subtrees.owner(home) == _subtrees.rank();
  for (int place = 0; place < 27; ++place) {
    if ((wanted >> place & 1) == 0) continue;
    const GridPoint p{c.x + static_cast<std::uint32_t>(place % 3) - 1,
                      c.y + static_cast<std::uint32_t>(place / 3 % 3) - 1,
                      c.z + static_cast<std::uint32_t>(place / 9) - 1};
    if (p.x >= range || p.y >= range || p.z >= range) continue;
    const std::uint64_t cell = morton_key(p);
    if (is_at_home && cell >> to_subtree == parent >> to_subtree) {
      _cells[level].push_back(cell);
      continue;
    }
    const std::size_t subtree = _subtrees.find(cell << below);
    if (level < _subtrees.level(subtree)) continue;  // it holds several subtrees
    const parallel::Rank owner = _subtrees.owner(subtree);
    if (owner == _subtrees.rank()) {
      _cells[level].push_back(cell);
    } else {
      _of_others.push_back({cell, owner});
    }
  }
}

void SplitCubes::balance() {
  for (int level = finest_level - 1; level > 0; --level) {
    keep_each_key_once(_cells[level]);
    const auto split_neighbours = [&](std::uint64_t parent, std::uint32_t wanted) {
      split_around(parent, level - 1, wanted);
    };
    // Cubes that hold several subtrees are known to every rank, and each sees to its own subtrees.
    for_each_parent(_above[level], split_neighbours);
    _of_others.clear();
    for_each_parent(_cells[level], split_neighbours);
    if (_subtrees.ranks() == 1) continue;
    for (const RemoteCell& other : parallel::deliver(_subtrees.communicator(), std::exchange(_of_others, {}),
                                                     [](const RemoteCell& r) { return r.owner; }))
      _cells[level - 1].push_back(other.cell);
  }
  keep_each_key_once(_cells[0]);
}

std::int64_t SplitCubes::leaf_count() const {
  std::int64_t split = 0;
  for (const std::vector<std::uint64_t>& cells : _cells) split += static_cast<std::int64_t>(cells.size());
  const std::int64_t subtrees = static_cast<std::int64_t>(_subtrees.count());
  return 7 * (_subtrees.ranks() > 1 ? _subtrees.communicator().sum(split) : split) + subtrees;
}

SplitCubes::Leaves SplitCubes::leaves() const {
  Leaves result;
  std::array<std::size_t, finest_level> next{};
  // Cells are met in Morton order, so on each level the split ones are met in the order of their list.
  const auto visit = [&](auto&& self, std::uint64_t key, int level) -> void {
    if (level < finest_level && next[level] < _cells[level].size() && _cells[level][next[level]] == key) {
      ++next[level];
      for (std::uint64_t child = 0; child < 8; ++child) self(self, key << 3 | child, level + 1);
    } else {
      result.keys.push_back(key << 3 * (finest_level - level));
      result.levels.push_back(static_cast<std::uint8_t>(level));
    }
  };
  const IndexRange own = own_subtrees();
  for (std::size_t subtree = own.first; subtree < own.last; ++subtree) {
    const int level = _subtrees.level(subtree);
    visit(visit, _subtrees.key(subtree) >> 3 * (finest_level - level), level);
  }
  return result;
}

}  // namespace aeroloom::sizing
