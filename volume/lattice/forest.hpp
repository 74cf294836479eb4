/// A distributed octree, made by p4est (Burstedde, Wilcox, Ghattas, SIAM J. Sci. Comput. 33, 2011,
/// doi:10.1137/100791634). It is balanced: leaves that touch differ by one level at most.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "volume/lattice/octants.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::forest {

/// Whether a cube is split. `descend`: it is split if one of its descendants is.
enum class RefineFlag { keep, split, descend };
/// Decides whether a cube is split. The result depends on the cube alone, and is the same on every rank. It
/// is never called for cubes of the finest level, nor below a cube that is kept. If it throws, all ranks do.
using RefineCriterion = std::function<RefineFlag(const geometry::GridCube&)>;

/// A balanced octree. Leaves are numbered along the Morton curve. Rank r owns the leaves from first(r) to
/// before first(r + 1). Eight leaves with one parent are on one rank. The leaves are the same on any number
/// of ranks. Immutable.
class Forest {
public:
  const parallel::Communicator& communicator() const { return _communicator; }
  std::int64_t count() const { return _firsts.back(); }
  std::int64_t first(parallel::Rank r) const { return _firsts[r]; }
  /// The leaves of this rank. Leaf i has the number first(rank) + i.
  const Octants& local() const { return _local; }
  /// The rank that owns the leaf which contains the finest cube with this key.
  parallel::Rank owner_of(std::uint64_t key) const {
    return static_cast<parallel::Rank>(std::upper_bound(_keys.begin(), _keys.end(), key) - _keys.begin() - 1);
  }

private:
  friend class Brick;
  parallel::Communicator _communicator;
  Octants _local;
  std::vector<std::int64_t> _firsts;  // per rank, and the end
  std::vector<std::uint64_t> _keys;   // per rank: of its first leaf; without leaves: as the next rank's
  int _tree_level = 0;                // at which the trees of p4est begin
  std::uint64_t _within = 0;          // a bit for each tree that is part of a leaf of another tree
};

/// The smallest balanced octree with all cubes split that the criterion splits. Ranks share the calls of the
/// criterion, level by level. A rank holds at most `octants` leaves; 0: as many as p4est can count and the
/// memory allows. Throws CollectiveError (resources) where it needs more. Collective.
Forest grow(const parallel::Communicator& communicator, const RefineCriterion& criterion,
            std::int64_t octants = 0);

/// The same leaves with a new partition. `weights` has one weight per leaf of this rank, none negative.
/// Collective.
Forest partition_by_weight(const Forest& forest, std::span<const std::int32_t> weights);

}  // namespace aeroloom::forest
