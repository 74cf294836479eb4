#include "volume/lattice/brick.hpp"

#include "parallel/communication/host.hpp"

#include <array>

#include <p8est_extended.h>
#include <p8est_io.h>

namespace aeroloom::forest {
namespace {

using geometry::finest_level;
using geometry::GridPoint;

// A tree of p4est has one level more in its coordinates than its leaves may have.
static_assert(finest_level == many_trees + P8EST_QMAXLEVEL && P8EST_MAXLEVEL == P8EST_QMAXLEVEL + 1);

p8est_connectivity_t* connect(int tree_level) {
  const int per_axis = 1 << tree_level;
  return p8est_connectivity_new_brick(per_axis, per_axis, per_axis, 0, 0, 0);
}

/// Leaves as p4est reads them: x, y, z in their tree, level.
struct Columns {
  static constexpr int width = 4;
  int tree_level;
  std::vector<p4est_qcoord_t> places;
  std::vector<std::int32_t> weights;
  std::vector<std::int64_t> trees;  // pairs: a tree that begins on this rank, number of own leaves before it

  std::int64_t count() const { return static_cast<std::int64_t>(places.size() / width); }
  void add(int tree, std::uint64_t in_tree, int level, std::int32_t weight) {
    if (in_tree == 0) {
      trees.push_back(tree);
      trees.push_back(count());
    }
    const GridPoint p = geometry::grid_point(in_tree);
    for (const std::uint32_t along : {p.x, p.y, p.z})
      places.push_back(static_cast<p4est_qcoord_t>(along >> (many_trees - tree_level))
                       << (P8EST_MAXLEVEL - P8EST_QMAXLEVEL));
    places.push_back(level);
    weights.push_back(weight);
  }
};

Columns columns_of(const Octants& leaves, int tree_level, std::span<const std::int32_t> weights) {
  Columns columns{tree_level, {}, {}, {}};
  const int shift = 3 * (finest_level - tree_level);
  columns.places.reserve(Columns::width * leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const int tree = static_cast<int>(leaves.keys[i] >> shift);
    const int level = leaves.levels[i] - tree_level;
    columns.add(tree, leaves.keys[i] & ((1ULL << shift) - 1), std::max(level, 0), weights[i]);
    for (int t = 1; t < 1 << 3 * std::max(-level, 0); ++t) columns.add(tree + t, 0, 0, 0);
  }
  return columns;
}

}  // namespace

Brick::Brick(const parallel::Communicator& communicator, int tree_level)
    : _communicator(communicator), _tree_level(tree_level), _connectivity(connect(tree_level)) {
  _forest.reset(p8est_new_ext(parallel::host_communicator(_communicator), _connectivity.get(), 0, 0, 1, 0,
                              nullptr, nullptr));
}

Brick::Brick(const Forest& forest, std::span<const std::int32_t> weights)
    : _communicator(forest._communicator),
      _tree_level(forest._tree_level),
      _within(forest._within),
      _connectivity(connect(_tree_level)) {
  Columns columns = columns_of(forest._local, _tree_level, weights);
  std::vector<p4est_gloidx_t> firsts{0};
  const std::vector<std::int64_t> mine{columns.count()};
  for (const std::int64_t count : _communicator.all_gather_items<std::int64_t>(mine))
    firsts.push_back(firsts.back() + count);
  for (std::size_t i = 1; i < columns.trees.size(); i += 2) columns.trees[i] += firsts[_communicator.rank()];
  const std::vector<std::int64_t> begins = _communicator.all_gather_items<std::int64_t>(columns.trees);
  std::array<p4est_gloidx_t, tree_count + 1> of_trees{};
  for (std::size_t i = 0; i < begins.size(); i += 2) of_trees[begins[i]] = begins[i + 1];
  of_trees[begins.size() / 2] = firsts.back();
  sc_array_t view;
  sc_array_init_data(&view, columns.places.data(), sizeof(p4est_qcoord_t), columns.places.size());
  _forest.reset(p8est_inflate(parallel::host_communicator(_communicator), _connectivity.get(), firsts.data(),
                              of_trees.data(), &view, nullptr, nullptr));
  std::size_t i = 0;
  for_each_octant([&](int, p8est_quadrant_t& octant) { octant.p.user_int = columns.weights[i++]; });
}

std::uint64_t Brick::key_of(int tree, const p8est_quadrant_t& octant) const {
  const auto finest = [this](p4est_qcoord_t along) {
    return static_cast<std::uint32_t>(along) >> (P8EST_MAXLEVEL - P8EST_QMAXLEVEL)
                                                    << (many_trees - _tree_level);
  };
  return key_of(tree) | geometry::morton_key({finest(octant.x), finest(octant.y), finest(octant.z)});
}

int Brick::level_at(int tree) const {
  return _tree_level == many_trees && tree % 8 == 0 && has(_within, tree + 1) ? many_trees - 1 : _tree_level;
}

TreeSet Brick::split_trees() const {
  // Each tree begins on one rank: sums are unions.
  TreeSet mine = 0;
  for (int t = _forest->first_local_tree; t <= _forest->last_local_tree; ++t) {
    const p8est_quadrant_t& first =
        *p8est_quadrant_array_index(&p8est_tree_array_index(_forest->trees, t)->quadrants, 0);
    if (first.level > 0 && first.x == 0 && first.y == 0 && first.z == 0) mine |= TreeSet{1} << t;
  }
  return static_cast<TreeSet>(_communicator.sum(static_cast<std::int64_t>(mine)));
}

Forest Brick::take() const {
  Forest result;
  result._communicator = _communicator;
  result._tree_level = _tree_level;
  result._within = _within;
  Octants& local = result._local;
  local.keys.reserve(_forest->local_num_quadrants);
  local.levels.reserve(_forest->local_num_quadrants);
  // Eight unsplit trees with one parent go to the rank of the first.
  const TreeSet split = _tree_level == one_tree ? ~TreeSet{0} : split_trees();
  for_each_octant([&](int tree, const p8est_quadrant_t& octant) {
    if ((split >> (tree & ~7) & 0xff) != 0)
      local.add(key_of(tree, octant), octant.level + _tree_level);
    else if (tree % 8 == 0) {
      for (int t = tree; t < tree + 8; ++t) {
        if (!has(_within, t)) local.add(key_of(t), level_at(t));
      }
    }
  });
  struct TreeStart {
    std::int64_t count;
    std::uint64_t key;
  };
  constexpr std::uint64_t end = 1ULL << 3 * finest_level;
  const std::vector<TreeStart> mine{
      {static_cast<std::int64_t>(local.size()), local.keys.empty() ? end : local.keys[0]}};
  const std::vector<TreeStart> rows = _communicator.all_gather_items<TreeStart>(mine);
  result._firsts.push_back(0);
  for (const TreeStart& row : rows) {
    result._firsts.push_back(result._firsts.back() + row.count);
    result._keys.push_back(row.key);
  }
  for (std::size_t r = rows.size() - 1; r-- > 0;)
    result._keys[r] = std::min(result._keys[r], result._keys[r + 1]);
  return result;
}

}  // namespace aeroloom::forest
