#include "volume/lattice/forest.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "volume/lattice/brick.hpp"
#include "volume/lattice/p4est_library.hpp"

#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <p8est_extended.h>

namespace aeroloom::forest {
namespace {

using geometry::finest_level;
using geometry::GridCube;
using geometry::GridPoint;
using parallel::Communicator;
using parallel::ScopedCpu;

/// Bytes that a leaf takes at most, while the forest is balanced and copied.
constexpr std::int64_t bytes_per_octant = 100;

/// What is known of the cubes above trees. Many of them are there because one is split, and so is the root.
struct Crown {
  TreeSet open = 1;         ///< trees that may be split
  std::uint8_t wanted = 0;  ///< cubes of level 1 that are to be split, a bit each
};

Crown judge_crown(const Judge& judge) {
  Crown crown{0, 0};
  for (int c = 0; c < 8; ++c) {
    const Verdict verdict = judge(GridCube{}.child(c));
    if (verdict != Verdict::keep) crown.open |= TreeSet{0xff} << 8 * c;
    if (verdict == Verdict::split) crown.wanted |= static_cast<std::uint8_t>(1 << c);
  }
  return crown;
}

/// The trees that are parts of larger leaves which begin in another: those of cubes of level 1 that nobody
/// wants split and that touch no split tree.
TreeSet trees_within(const Crown& crown, TreeSet split) {
  unsigned parents = crown.wanted;
  for (int t = 0; t < tree_count; ++t) {
    if (!has(split, t)) continue;
    const GridPoint p = geometry::grid_point(static_cast<std::uint64_t>(t));
    for (int c = 0; c < 8; ++c) {
      const auto touches = [](std::uint32_t tree, int half) { return half != 0 ? tree >= 1 : tree <= 2; };
      if (touches(p.x, c & 1) && touches(p.y, c & 2) && touches(p.z, c & 4)) parents |= 1U << c;
    }
  }
  TreeSet within = 0;
  for (int c = 0; c < 8; ++c)
    if ((parents >> c & 1) == 0) within |= TreeSet{0xfe} << 8 * c;
  return within;
}

/// The state of a forest that grows, behind its user_pointer.
struct Growth {
  const Judge& judge;
  const Brick& brick;
  TreeSet open;
  std::int64_t limit;
  std::int64_t count = 0;  ///< leaves of this rank
  int from = 0, to = 0;    ///< levels whose cubes are judged, the last not included
  bool is_full = false, is_too_deep = false;
  std::exception_ptr failure = nullptr;  ///< C code on the way: it has to wait
};

Growth& growth_of(p8est_t* forest) {
  return *static_cast<Growth*>(forest->user_pointer);
}

bool is_split(const Judge& judge, const GridCube& cube) {
  if (cube.level >= finest_level) return false;
  const Verdict verdict = judge(cube);
  if (verdict != Verdict::look_below) return verdict == Verdict::split;
  for (int c = 0; c < 8; ++c)
    if (is_split(judge, cube.child(c))) return true;
  return false;
}

int refine_if_split(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* octant) {
  Growth& growth = growth_of(forest);
  const int level = octant->level + growth.brick.tree_level();
  if (level < growth.from || level >= growth.to || !has(growth.open, tree)) return 0;
  if (growth.is_full || growth.is_too_deep || growth.failure) return 0;
  try {
    const GridCube cube = growth.brick.cube_of(tree, *octant);
    if (!is_split(growth.judge, cube)) return 0;
    // Its children are as small as leaves of this tree can be: they are not asked for again.
    for (int c = 0; c < 8 && level + 1 == growth.brick.finest(); ++c)
      growth.is_too_deep = growth.is_too_deep || is_split(growth.judge, cube.child(c));
  } catch (...) {
    growth.failure = std::current_exception();
    return 0;
  }
  growth.count += 7;
  growth.is_full = growth.count > growth.limit;
  return growth.is_full ? 0 : 1;
}

/// Counts what balance adds, which cannot be stopped otherwise.
void count_octant(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t*) {
  Growth& growth = growth_of(forest);
  if (++growth.count > growth.limit) end_without_memory();
}

/// Leaves that will be judged weigh more: below them there may be others.
int weight_while_growing(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t* octant) {
  constexpr int of_judged = 16;
  const Growth& growth = growth_of(forest);
  return octant->level + growth.brick.tree_level() >= growth.from ? of_judged : 1;
}

int given_weight(p8est_t*, p4est_topidx_t, p8est_quadrant_t* octant) {
  return octant->p.user_int;
}

std::int64_t most_octants(const Communicator& communicator, const Limits& limits) {
  if (limits.octants > 0) return limits.octants;
  const int ranks_here = parallel::find_node_shape(communicator).ranks_here;
  const std::int64_t bytes = parallel::allowed_for_child(parallel::node_memory_bytes() / ranks_here);
  return std::min<std::int64_t>(bytes / bytes_per_octant, std::numeric_limits<p4est_locidx_t>::max());
}

/// Splits what is judged so; on several ranks level by level, distributed anew after each. False: the trees
/// have too few levels.
bool refine(const Communicator& communicator, Brick& brick, Growth& growth) {
  p8est_t& forest = brick.forest();
  const bool is_alone = communicator.size() == 1;
  for (int level = brick.tree_level(); level < brick.finest(); ++level) {
    growth.from = level;
    growth.to = is_alone ? brick.finest() : level + 1;
    growth.count = forest.local_num_quadrants;
    const std::int64_t before = forest.global_num_quadrants;
    {
      const ScopedCpu task(ScopedCpu::As::task);
      p8est_refine_ext(&forest, 1, P8EST_QMAXLEVEL, refine_if_split, nullptr, nullptr);
    }
    if (is_alone || forest.global_num_quadrants == before) break;
    growth.from = level + 1;
    p8est_partition_ext(&forest, 0, weight_while_growing);
  }
  parallel::agree(communicator, [&] {
    if (growth.failure) std::rethrow_exception(growth.failure);
  });
  if (communicator.maximum(std::int64_t{growth.is_full}) > 0)
    throw parallel::CollectiveError(
        parallel::FailureKind::resources,
        fmt::format("the octree of the lattice would take more than {} cubes on one rank, more than its "
                    "memory allows. Ask for larger elements (SizingOptions::minimum), or use more ranks",
                    growth.limit));
  return communicator.maximum(std::int64_t{growth.is_too_deep}) == 0;
}

/// Nothing where the trees have too few levels.
std::optional<Forest> grow_in(const Communicator& communicator, int tree_level, const Crown& crown,
                              const Judge& judge, std::int64_t limit) {
  LibraryScope library(communicator.rank(), "refining");
  Brick brick(communicator, tree_level);
  Growth growth{judge, brick, crown.open, limit};
  brick.forest().user_pointer = &growth;
  if (!refine(communicator, brick, growth)) return std::nullopt;
  library.now("balancing");
  growth.count = brick.forest().local_num_quadrants;
  {
    const ScopedCpu task(ScopedCpu::As::task);
    p8est_balance_ext(&brick.forest(), P8EST_CONNECT_FULL, count_octant, nullptr);
  }
  library.now("partitioning");
  p8est_partition_ext(&brick.forest(), 1, nullptr);
  if (tree_level == many_trees) brick.unite(trees_within(crown, brick.split_trees()));
  const ScopedCpu task(ScopedCpu::As::task);
  return brick.take();
}

}  // namespace

Forest grow(const Communicator& communicator, const Judge& judge, Limits limits) {
  const std::int64_t limit = most_octants(communicator, limits);
  Crown crown;
  if (auto grown = grow_in(communicator, one_tree, crown, judge, limit)) return std::move(*grown);
  parallel::collectively(communicator, ScopedCpu::As::repeated, [&] { crown = judge_crown(judge); });
  return *grow_in(communicator, many_trees, crown, judge, limit);
}

Forest partition_by_weight(const Communicator& communicator, const Forest& forest,
                           std::span<const std::int32_t> weights) {
  const LibraryScope library(communicator.rank(), "partitioning");
  const ScopedCpu task(ScopedCpu::As::task);
  Brick brick(communicator, forest, weights);
  p8est_partition_ext(&brick.forest(), 1, given_weight);
  return brick.take();
}

}  // namespace aeroloom::forest
