#include "volume/lattice_tree.hpp"

#include <cmath>

namespace aeroloom::volume {

using geometry::Vec3;
using sizing::finest_level;
using sizing::SplitCubes;

namespace {

/// Cubes that are looked at by every rank alike, before the rest is shared out.
constexpr std::size_t common_cells = 4096;

/// Finds the cubes that sizes want split.
class SplitSearch {
public:
  SplitSearch(const LatticeFrame& frame, const sizing::SizeField& field, const GridBox& box)
      : _frame(frame), _field(field), _box(box), _slope(slope_margin * std::log(field.options().growth)) {}

  enum class Verdict { keep, split, look_below };

  /// A split cube's centre sees a small size. In fields so steep that it may miss one in a corner, children
  /// are looked at where that is possible.
  Verdict judge(const GridCube& cube) const {
    if (cube.level >= finest_level || !GridBox::of(cube).overlaps(_box)) return Verdict::keep;
    const double edge = _frame.edge(cube.level), half = 0.5 * cube.edge();
    const double size = _field(_frame.to_space(GridBox::of(cube).low + Vec3{half, half, half}));
    if (edge * mean_edge_of_cell > LatticeTree::coarsest_edge * size) return Verdict::split;
    constexpr double half_diagonal = 0.5 * std::numbers::sqrt3;
    constexpr double harmless = mean_edge_of_cell / LatticeTree::coarsest_edge / half_diagonal;
    const bool may_miss = _slope > harmless && size < _slope * half_diagonal * edge &&
                          edge * mean_edge_of_cell > LatticeTree::coarsest_edge * _field.minimum();
    return may_miss ? Verdict::look_below : Verdict::keep;
  }

  void search(const GridCube& cube, std::vector<std::uint64_t>& found) const {
    const Verdict verdict = judge(cube);
    if (verdict == Verdict::keep) return;
    if (verdict == Verdict::split) found.push_back(name(cube));
    for (int child = 0; child < 8; ++child) search(child_of(cube, child), found);
  }

  static GridCube child_of(const GridCube& cube, int child) {
    const std::uint32_t half = cube.edge() >> 1;
    return {{cube.low.x + (child & 1 ? half : 0), cube.low.y + (child & 2 ? half : 0),
             cube.low.z + (child & 4 ? half : 0)},
            cube.level + 1};
  }
  /// Level and place of a cube in one word: a bit above its level key.
  static std::uint64_t name(const GridCube& cube) {
    return 1ULL << 3 * cube.level | sizing::morton_key(cube.low) >> 3 * (finest_level - cube.level);
  }

private:
  const LatticeFrame& _frame;
  const sizing::SizeField& _field;
  GridBox _box;
  double _slope;
};

/// The cubes that sizes want split, on every rank.
std::vector<std::uint64_t> find_splits(const parallel::Communicator& communicator, const SplitSearch& search,
                                       parallel::StageClock& clock) {
  std::vector<std::uint64_t> common, mine;
  std::vector<GridCube> open{{{}, 0}};
  {
    const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
    while (!open.empty() && open.size() < common_cells) {
      std::vector<GridCube> next;
      for (const GridCube& cube : open) {
        const SplitSearch::Verdict verdict = search.judge(cube);
        if (verdict == SplitSearch::Verdict::keep) continue;
        if (verdict == SplitSearch::Verdict::split) common.push_back(SplitSearch::name(cube));
        for (int child = 0; child < 8; ++child) next.push_back(SplitSearch::child_of(cube, child));
      }
      open.swap(next);
    }
  }
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (std::size_t i = communicator.rank(); i < open.size(); i += communicator.size())
      search.search(open[i], mine);
  }
  std::vector<std::uint64_t> all = communicator.all_gather_items<std::uint64_t>(mine);
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

}  // namespace

LatticeTree::LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
                         const sizing::SizeField& field, const GridBox& box, parallel::StageClock& clock) {
  const std::vector<std::uint64_t> splits = find_splits(communicator, SplitSearch(frame, field, box), clock);
  const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
  SplitCubes cubes;
  for (const std::uint64_t name : splits) {
    const int level = (63 - __builtin_clzll(name)) / 3;
    cubes.split((name ^ 1ULL << 3 * level) << 3 * (finest_level - level), level);
  }
  cubes.balance();
  const SplitCubes::Leaves leaves = cubes.leaves();
  for (std::size_t i = 0; i < leaves.keys.size();) {
    const int level = leaves.levels[i], shift = 3 * (finest_level - level);
    bool whole = level > 0 && (leaves.keys[i] >> shift & 7) == 0 && i + 8 <= leaves.keys.size();
    for (std::size_t k = 1; whole && k < 8; ++k) whole = leaves.levels[i + k] == level;
    _blocks.keys.push_back(leaves.keys[i]);
    _blocks.levels.push_back(static_cast<std::uint8_t>(whole ? level - 1 : level));
    _split.push_back(whole);
    i += whole ? 8 : 1;
  }
  _table = sizing::LeafTable(_blocks);
}

GridCube LatticeTree::leaf(BlockIndex b, int child) const {
  return _split[b] ? SplitSearch::child_of(cube(b), child) : cube(b);
}

bool LatticeTree::is_split(const GridCube& cube) const {
  const BlockIndex b = block_at(cube.low);
  return _blocks.levels[b] > cube.level || (_blocks.levels[b] == cube.level && _split[b]);
}

}  // namespace aeroloom::volume
