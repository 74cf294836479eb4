#include "volume/lattice_tree.hpp"

#include "forest/forest.hpp"
#include "parallel/collective_error.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::volume {

using forest::Verdict;
using geometry::Vec3;
using sizing::finest_level;

namespace {

/// Tells which cubes sizes want split. A split cube's centre sees a small size. In fields so steep that it
/// may miss one in a corner, children are looked at where that is possible.
class SplitSearch {
public:
  SplitSearch(const LatticeFrame& frame, const sizing::SizeField& field, const geometry::Box& box)
      : _frame(frame), _field(field), _box(box), _slope(slope_margin * std::log(field.options().growth)) {}

  Verdict operator()(const GridCube& cube) const {
    if (!_frame.box_around(cube).overlaps(_box)) return Verdict::keep;
    const double edge = _frame.edge(cube.level), size = _field(_frame.middle_of(cube));
    if (edge * mean_edge_of_cell > LatticeTree::coarsest_edge * size) return Verdict::split;
    constexpr double half_diagonal = 0.5 * std::numbers::sqrt3;
    constexpr double harmless = mean_edge_of_cell / LatticeTree::coarsest_edge / half_diagonal;
    const bool may_miss = _slope > harmless && size < _slope * half_diagonal * edge &&
                          edge * mean_edge_of_cell > LatticeTree::coarsest_edge * _field.minimum();
    return may_miss ? Verdict::look_below : Verdict::keep;
  }

private:
  const LatticeFrame& _frame;
  const sizing::SizeField& _field;
  geometry::Box _box;
  double _slope;
};

/// A block in one word: whether it has eight leaves, above that its place among the cubes of its level, and a
/// bit that tells the level.
std::uint64_t word_of(std::uint64_t key, int level, bool is_split) {
  return (1ULL << 3 * level | key >> 3 * (finest_level - level)) << 1 | (is_split ? 1 : 0);
}

/// The blocks of this rank's leaves: eight of one parent are one.
std::vector<std::uint64_t> blocks_of(const forest::Octants& leaves) {
  std::vector<std::uint64_t> blocks;
  for (std::size_t i = 0; i < leaves.size();) {
    const int level = leaves.levels[i], shift = 3 * (finest_level - level);
    bool whole = level > 0 && (leaves.keys[i] >> shift & 7) == 0 && i + 8 <= leaves.size();
    for (std::size_t k = 1; whole && k < 8; ++k) whole = leaves.levels[i + k] == level;
    blocks.push_back(word_of(leaves.keys[i], whole ? level - 1 : level, whole));
    i += whole ? 8 : 1;
  }
  return blocks;
}

}  // namespace

LatticeTree::LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
                         const sizing::SizeField& field, const geometry::Box& box,
                         parallel::StageClock& clock) {
  std::vector<std::uint64_t> mine;
  {
    const forest::Forest forest = forest::grow(communicator, SplitSearch(frame, field, box), clock);
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    mine = blocks_of(forest.local());
  }
  const std::int64_t count = communicator.sum(static_cast<std::int64_t>(mine.size()));
  if (count > std::numeric_limits<BlockIndex>::max())
    throw parallel::CollectiveError(
        parallel::FailureKind::resources,
        fmt::format("the lattice would take {} blocks, more than can be numbered. Ask for larger elements "
                    "(SizingOptions::minimum)",
                    count));
  const std::vector<std::uint64_t> all = communicator.all_gather_items<std::uint64_t>(mine);
  const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
  _blocks.keys.reserve(all.size());
  _blocks.levels.reserve(all.size());
  _split.reserve(all.size());
  for (const std::uint64_t word : all) {
    const int level = (62 - __builtin_clzll(word)) / 3;
    _blocks.keys.push_back((word >> 1 ^ 1ULL << 3 * level) << 3 * (finest_level - level));
    _blocks.levels.push_back(static_cast<std::uint8_t>(level));
    _split.push_back(word & 1);
  }
  _table = sizing::LeafTable(_blocks);
}

GridCube LatticeTree::leaf(BlockIndex b, int child) const {
  return _split[b] ? cube(b).child(child) : cube(b);
}

bool LatticeTree::is_split(const GridCube& cube) const {
  const BlockIndex b = block_at(cube.low);
  return _blocks.levels[b] > cube.level || (_blocks.levels[b] == cube.level && _split[b]);
}

}  // namespace aeroloom::volume
