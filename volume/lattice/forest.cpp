#include "volume/lattice/forest.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/timers.hpp"
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

/// The most memory that a leaf takes while the forest is balanced and copied.
constexpr std::int64_t bytes_per_octant = 100;

/// The cubes above many trees. Many trees are used only if some cube is too fine for one, so the root is
/// split.
struct CoarseCubes {
  TreeSet open = 1;         ///< trees that may be split
  std::uint8_t wanted = 0;  ///< cubes of level 1 that are to be split, as bits
};

CoarseCubes flag_coarse_cubes(const RefineCriterion& criterion) {
  CoarseCubes coarse{0, 0};
  for (int c = 0; c < 8; ++c) {
    const RefineFlag flag = criterion(GridCube{}.child(c));
    if (flag != RefineFlag::keep) coarse.open |= TreeSet{0xff} << 8 * c;
    if (flag == RefineFlag::split) coarse.wanted |= static_cast<std::uint8_t>(1 << c);
  }
  return coarse;
}

/// The trees that are part of a leaf of another tree: those in cubes of level 1 that need no split and touch
/// no split tree.
TreeSet trees_within(const CoarseCubes& coarse, TreeSet split) {
  unsigned parents = coarse.wanted;
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

/// The state of a forest while it is refined, behind its user_pointer.
struct Growth {
  const RefineCriterion& criterion;
  const Brick& brick;
  TreeSet open;
  std::int64_t limit;
  std::int64_t count = 0;  ///< leaves of this rank
  int from = 0, to = 0;    ///< the criterion is called for these levels; `to` is excluded
  bool is_full = false, is_too_deep = false;
  std::exception_ptr failure = nullptr;  ///< thrown once the C code has returned
};

Growth& growth_of(p8est_t* forest) {
  return *static_cast<Growth*>(forest->user_pointer);
}

bool is_split(const RefineCriterion& criterion, const GridCube& cube) {
  if (cube.level >= finest_level) return false;
  const RefineFlag flag = criterion(cube);
  if (flag != RefineFlag::descend) return flag == RefineFlag::split;
  for (int c = 0; c < 8; ++c)
    if (is_split(criterion, cube.child(c))) return true;
  return false;
}

int refine_if_split(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* octant) {
  Growth& growth = growth_of(forest);
  const int level = octant->level + growth.brick.tree_level();
  if (level < growth.from || level >= growth.to || !has(growth.open, tree)) return 0;
  if (growth.is_full || growth.is_too_deep || growth.failure) return 0;
  try {
    const GridCube cube = growth.brick.cube_of(tree, *octant);
    if (!is_split(growth.criterion, cube)) return 0;
    // p4est does not call this for children of the finest level.
    for (int c = 0; c < 8 && level + 1 == growth.brick.finest(); ++c)
      growth.is_too_deep = growth.is_too_deep || is_split(growth.criterion, cube.child(c));
  } catch (...) {
    growth.failure = std::current_exception();
    return 0;
  }
  growth.count += 7;
  growth.is_full = growth.count > growth.limit;
  return growth.is_full ? 0 : 1;
}

/// Counts the leaves that balancing adds. It cannot be stopped otherwise.
void count_octant(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t*) {
  Growth& growth = growth_of(forest);
  if (++growth.count > growth.limit) end_without_memory();
}

/// Leaves that may still be split weigh more.
int weight_while_growing(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t* octant) {
  constexpr int of_candidate = 16;
  const Growth& growth = growth_of(forest);
  return octant->level + growth.brick.tree_level() >= growth.from ? of_candidate : 1;
}

int given_weight(p8est_t*, p4est_topidx_t, p8est_quadrant_t* octant) {
  return octant->p.user_int;
}

/// How many leaves the memory of a rank allows, and p4est can count.
std::int64_t most_octants(const Communicator& communicator) {
  const int ranks_here = parallel::find_node_shape(communicator).ranks_here;
  const std::int64_t bytes = parallel::allowed_for_child(parallel::node_memory_bytes() / ranks_here);
  return std::min<std::int64_t>(bytes / bytes_per_octant, std::numeric_limits<p4est_locidx_t>::max());
}

/// Splits by the criterion; on several ranks level by level, with a new partition after each. Returns false
/// if the trees have too few levels.
bool refine(Brick& brick, Growth& growth) {
  const Communicator& communicator = brick.communicator();
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

/// Nothing if the trees have too few levels.
std::optional<Forest> grow_in(const Communicator& communicator, int tree_level, const CoarseCubes& coarse,
                              const RefineCriterion& criterion, std::int64_t limit) {
  LibraryScope library(communicator.rank(), "refining");
  Brick brick(communicator, tree_level);
  Growth growth{criterion, brick, coarse.open, limit};
  brick.forest().user_pointer = &growth;
  if (!refine(brick, growth)) return std::nullopt;
  library.now("balancing");
  growth.count = brick.forest().local_num_quadrants;
  {
    const ScopedCpu task(ScopedCpu::As::task);
    p8est_balance_ext(&brick.forest(), P8EST_CONNECT_FULL, count_octant, nullptr);
  }
  library.now("partitioning");
  p8est_partition_ext(&brick.forest(), 1, nullptr);
  if (tree_level == many_trees) brick.unite(trees_within(coarse, brick.split_trees()));
  const ScopedCpu task(ScopedCpu::As::task);
  return brick.take();
}

}  // namespace

Forest grow(const Communicator& communicator, const RefineCriterion& criterion, std::int64_t octants) {
  const std::int64_t limit = octants > 0 ? octants : most_octants(communicator);
  CoarseCubes coarse;
  if (auto grown = grow_in(communicator, one_tree, coarse, criterion, limit)) return std::move(*grown);
  parallel::collectively(communicator, ScopedCpu::As::repeated,
                         [&] { coarse = flag_coarse_cubes(criterion); });
  return *grow_in(communicator, many_trees, coarse, criterion, limit);
}

Forest partition_by_weight(const Forest& forest, std::span<const std::int32_t> weights) {
  const LibraryScope library(forest.communicator().rank(), "partitioning");
  const ScopedCpu task(ScopedCpu::As::task);
  Brick brick(forest, weights);
  p8est_partition_ext(&brick.forest(), 1, given_weight);
  return brick.take();
}

}  // namespace aeroloom::forest
