#include "volume/lattice/lattice_tree.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/forest.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::volume {

using forest::RefineFlag;
using sizing::finest_level;

namespace {

/// Splits a cube by the size at its centre. If the field is so steep that the centre can miss a small size in
/// a corner, the children are checked too.
class SplitSearch {
public:
  SplitSearch(const LatticeFrame& frame, const sizing::SizeField& field, const geometry::Box& box)
      : _frame(frame), _field(field), _box(box), _slope(slope_margin * std::log(field.options().growth)) {}

  RefineFlag operator()(const GridCube& cube) const {
    if (!_frame.box_around(cube).overlaps(_box)) return RefineFlag::keep;
    const double edge = _frame.edge(cube.level), size = _field(_frame.middle_of(cube));
    if (edge * mean_edge_of_cell > LatticeTree::coarsest_edge * size) return RefineFlag::split;
    constexpr double half_diagonal = 0.5 * std::numbers::sqrt3;
    constexpr double harmless = mean_edge_of_cell / LatticeTree::coarsest_edge / half_diagonal;
    const bool may_miss = _slope > harmless && size < _slope * half_diagonal * edge &&
                          edge * mean_edge_of_cell > LatticeTree::coarsest_edge * _field.minimum();
    return may_miss ? RefineFlag::descend : RefineFlag::keep;
  }

private:
  const LatticeFrame& _frame;
  const sizing::SizeField& _field;
  geometry::Box _box;
  double _slope;
};

/// The expected work for a leaf, for a triangle, and in addition for a leaf that the surface meets.
constexpr std::int32_t leaf_work = 1, triangle_work = 4, met_work = 4;

/// Packs a block into a word. From the lowest bit: whether it has eight leaves, its Morton key on its level,
/// and one bit that marks the level.
std::uint64_t word_of(std::uint64_t key, int level, bool is_split) {
  return (1ULL << 3 * level | key >> 3 * (finest_level - level)) << 1 | (is_split ? 1 : 0);
}
int level_of(std::uint64_t word) {
  return (62 - __builtin_clzll(word)) / 3;
}
std::uint64_t key_of(std::uint64_t word) {
  const int level = level_of(word);
  return (word >> 1 ^ 1ULL << 3 * level) << 3 * (finest_level - level);
}

/// The blocks of this rank's leaves: eight leaves of one parent are one block.
std::vector<PackedBlock> blocks_of(const forest::Octants& leaves) {
  std::vector<PackedBlock> blocks;
  for (std::size_t i = 0; i < leaves.size();) {
    const int level = leaves.levels[i], shift = 3 * (finest_level - level);
    bool whole = level > 0 && (leaves.keys[i] >> shift & 7) == 0 && i + 8 <= leaves.size();
    for (std::size_t k = 1; whole && k < 8; ++k) whole = leaves.levels[i + k] == level;
    blocks.push_back({0, word_of(leaves.keys[i], whole ? level - 1 : level, whole)});
    i += whole ? 8 : 1;
  }
  return blocks;
}

std::vector<std::int32_t> weigh(const forest::Forest& forest,
                                const std::vector<std::uint64_t>& triangle_keys) {
  struct Key {
    std::uint64_t key;
  };
  std::vector<Key> keys;
  keys.reserve(triangle_keys.size());
  for (const std::uint64_t key : triangle_keys) keys.push_back({key});
  std::vector<std::int32_t> weights(forest.local().size(), leaf_work);
  for (const Key& key : mesh::deliver(forest.communicator(), std::move(keys),
                                      [&](const Key& k) { return forest.owner_of(k.key); })) {
    std::int32_t& weight = weights[forest.local().find(key.key)];
    weight += triangle_work + (weight == leaf_work ? met_work : 0);
  }
  return weights;
}

}  // namespace

LatticeTree::LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
                         const sizing::SizeField& field, const geometry::Box& box,
                         const std::vector<std::uint64_t>& triangle_keys)
    : _communicator(communicator) {
  std::vector<PackedBlock> mine;
  {
    forest::Forest forest = forest::grow(communicator, SplitSearch(frame, field, box));
    if (communicator.size() > 1) forest = forest::partition_by_weight(forest, weigh(forest, triangle_keys));
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    mine = blocks_of(forest.local());
  }
  constexpr std::uint64_t end = 1ULL << 3 * finest_level;
  struct BlockStart {
    BlockNumber count;
    std::uint64_t key;
  };
  const std::array row{
      BlockStart{static_cast<BlockNumber>(mine.size()), mine.empty() ? end : key_of(mine.front().word)}};
  _firsts.push_back(0);
  for (const BlockStart& of_rank : communicator.all_gather_items<BlockStart>(row)) {
    _firsts.push_back(_firsts.back() + of_rank.count);
    _keys.push_back(of_rank.key);
  }
  for (std::size_t r = _keys.size() - 1; r-- > 0;) _keys[r] = std::min(_keys[r], _keys[r + 1]);
  if (total() > std::numeric_limits<BlockIndex>::max())
    throw parallel::CollectiveError(
        parallel::FailureKind::resources,
        fmt::format("the lattice would take {} blocks, more than can be numbered. Ask for larger elements "
                    "(SizingOptions::minimum)",
                    total()));
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  const BlockNumber first = _firsts[communicator.rank()];
  for (std::size_t i = 0; i < mine.size(); ++i) mine[i].number = first + static_cast<BlockNumber>(i);
  fill(mine, first, static_cast<BlockIndex>(mine.size()));
}

/// Placeholders in the gaps between blocks are as large as possible, so that there are few.
void LatticeTree::fill(const std::vector<PackedBlock>& blocks, BlockNumber first, BlockIndex own) {
  _blocks = {};
  _split.clear(), _numbers.clear(), _local.clear();
  const auto add = [&](std::uint64_t key, int level, bool split, BlockNumber number) {
    _blocks.keys.push_back(key);
    _blocks.levels.push_back(static_cast<std::uint8_t>(level));
    _split.push_back(split);
    _numbers.push_back(number);
  };
  constexpr std::uint64_t end = 1ULL << 3 * finest_level;
  std::uint64_t at = 0;
  const auto fill_up_to = [&](std::uint64_t key) {
    while (at < key) {
      int level = finest_level;
      while (level > 0) {
        const std::uint64_t larger = 1ULL << 3 * (finest_level - level + 1);
        if (at % larger != 0 || at + larger > key) break;
        --level;
      }
      add(at, level, false, -1);
      at += 1ULL << 3 * (finest_level - level);
    }
  };
  for (const PackedBlock& block : blocks) {
    const std::uint64_t key = key_of(block.word);
    const int level = level_of(block.word);
    fill_up_to(key);
    if (own > 0 && block.number == first) _first = block_count();
    _local.push_back(block_count());
    add(key, level, block.word & 1, block.number);
    at = key + (1ULL << 3 * (finest_level - level));
  }
  fill_up_to(end);
  _last = _first + own;
  if (static_cast<BlockNumber>(blocks.size()) == total()) _numbers.clear(), _local.clear();
  _table = sizing::LeafTable(_blocks);
}

GridCube PackedBlock::cube() const {
  return {sizing::grid_point(key_of(word)), level_of(word)};
}

PackedBlock LatticeTree::packed(BlockIndex b) const {
  return {number(b), word_of(_blocks.keys[b], _blocks.levels[b], _split[b] != 0)};
}

void LatticeTree::add(std::vector<PackedBlock> blocks) {
  for (BlockIndex b = 0; b < block_count(); ++b) {
    if (is_local(b)) blocks.push_back(packed(b));
  }
  geometry::sort_unique(
      blocks, [](const PackedBlock& a, const PackedBlock& b) { return a.number < b.number; },
      [](const PackedBlock& a, const PackedBlock& b) { return a.number == b.number; });
  fill(blocks, _first < _last ? number(_first) : 0, _last - _first);
}

BlockIndex LatticeTree::find(BlockNumber number) const {
  if (_numbers.empty()) return static_cast<BlockIndex>(number);
  if (_first < _last) {
    const BlockNumber own = number - _numbers[_first];
    if (own >= 0 && own < _last - _first) return _first + static_cast<BlockIndex>(own);
  }
  const auto at = std::lower_bound(_local.begin(), _local.end(), number,
                                   [&](BlockIndex b, BlockNumber wanted) { return _numbers[b] < wanted; });
  return at != _local.end() && _numbers[*at] == number ? *at : -1;
}

void LatticeTree::throw_not_local() {
  throw std::logic_error("a block of the lattice was requested that is not local to this rank");
}

GridCube LatticeTree::leaf(BlockIndex b, int child) const {
  return _split[b] ? cube(b).child(child) : cube(b);
}

bool LatticeTree::is_split(const GridCube& cube) const {
  const BlockIndex b = any_at(cube.low);
  if (!is_local(b)) return true;
  return _blocks.levels[b] > cube.level || (_blocks.levels[b] == cube.level && _split[b]);
}

}  // namespace aeroloom::volume
