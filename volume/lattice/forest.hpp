/// A distributed octree whose leaves differ by one level at most across faces, edges and corners, made by
/// p4est (Burstedde, Wilcox, Ghattas, SIAM J. Sci. Comput. 33, 2011, doi:10.1137/100791634), which no other
/// folder sees.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "volume/lattice/octants.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::forest {

/// What becomes of a cube: it is no finer than it is, it is split, or only its descendants tell: those that
/// are split split it too.
enum class Verdict { keep, split, look_below };
/// A function of the cube alone, the same on every rank; what it throws, all ranks throw. Not asked of cubes
/// of the finest level, nor below one that is kept; of the same cube possibly more than once.
using Judge = std::function<Verdict(const geometry::GridCube&)>;

/// Balanced leaves, numbered along the Morton curve of the whole root: rank r has those from first(r) to
/// first(r + 1). Eight leaves with one parent are on one rank. Which leaves there are is the same on any
/// number of ranks. Immutable.
class Forest {
public:
  const parallel::Communicator& communicator() const { return _communicator; }
  std::int64_t count() const { return _firsts.back(); }
  std::int64_t first(parallel::Rank r) const { return _firsts[r]; }
  /// Leaf i of this rank has the number first(rank) + i.
  const Octants& local() const { return _local; }
  /// The rank that has the leaf which holds the finest cube with this key.
  parallel::Rank owner_of(std::uint64_t key) const {
    return static_cast<parallel::Rank>(std::upper_bound(_keys.begin(), _keys.end(), key) - _keys.begin() - 1);
  }

private:
  friend class Brick;
  parallel::Communicator _communicator;
  Octants _local;
  std::vector<std::int64_t> _firsts;  // per rank, and the end
  std::vector<std::uint64_t>
      _keys;                  // per rank: where its leaves begin, those of a rank without any the next's
  int _tree_level = 0;        // of p4est, that it was made with
  std::uint64_t _within = 0;  // trees of the brick that lie in leaves that begin in another
};

/// The smallest balanced octree that has all cubes split which are judged so. Ranks share the judging, level
/// by level. A rank holds at most `octants` of them; 0: as many as p4est can count and its memory allows.
/// Throws CollectiveError (resources) where it takes more. Collective.
Forest grow(const parallel::Communicator& communicator, const Judge& judge, std::int64_t octants = 0);

/// A forest with the same leaves, partitioned by weights, one per leaf of this rank, none negative.
/// Collective.
Forest partition_by_weight(const Forest& forest, std::span<const std::int32_t> weights);

}  // namespace aeroloom::forest
