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

SplitCubes::SplitCubes(Pages pages) : _pages(std::move(pages)) {
  for (std::size_t page = 0; page < _pages.count(); ++page) {
    for (int level = _pages.level(page) - 1; level >= 0; --level) {
      const std::uint64_t cell = _pages.key(page) >> 3 * (finest_level - level);
      // Pages come along the curve, so cells above them do.
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
  const std::size_t home = _pages.find(parent << below);
  const int to_page = 3 * (level - _pages.level(home));
  const bool is_at_home = to_page >= 0 && _pages.owner(home) == _pages.rank();
  for (int place = 0; place < 27; ++place) {
    if ((wanted >> place & 1) == 0) continue;
    const GridPoint p{c.x + static_cast<std::uint32_t>(place % 3) - 1,
                      c.y + static_cast<std::uint32_t>(place / 3 % 3) - 1,
                      c.z + static_cast<std::uint32_t>(place / 9) - 1};
    if (p.x >= range || p.y >= range || p.z >= range) continue;
    const std::uint64_t cell = morton_key(p);
    if (is_at_home && cell >> to_page == parent >> to_page) {
      _cells[level].push_back(cell);
      continue;
    }
    const std::size_t page = _pages.find(cell << below);
    if (level < _pages.level(page)) continue;  // it holds several pages
    const parallel::Rank owner = _pages.owner(page);
    if (owner == _pages.rank()) {
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
    // Cubes that hold several pages are known to every rank, and each sees to its own pages.
    for_each_parent(_above[level], split_neighbours);
    _of_others.clear();
    for_each_parent(_cells[level], split_neighbours);
    if (_pages.ranks() == 1) continue;
    for (const Request& request : parallel::deliver(_pages.communicator(), std::exchange(_of_others, {}),
                                                    [](const Request& r) { return r.owner; }))
      _cells[level - 1].push_back(request.cell);
  }
  keep_each_key_once(_cells[0]);
}

std::int64_t SplitCubes::leaf_count() const {
  std::int64_t split = 0;
  for (const std::vector<std::uint64_t>& cells : _cells) split += static_cast<std::int64_t>(cells.size());
  const std::int64_t pages = static_cast<std::int64_t>(_pages.count());
  return 7 * (_pages.ranks() > 1 ? _pages.communicator().sum(split) : split) + pages;
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
  const IndexRange own = own_pages();
  for (std::size_t page = own.first; page < own.last; ++page) {
    const int level = _pages.level(page);
    visit(visit, _pages.key(page) >> 3 * (finest_level - level), level);
  }
  return result;
}

}  // namespace aeroloom::sizing
