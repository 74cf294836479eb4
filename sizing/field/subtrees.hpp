/// How the root cube of an octree is divided among the ranks.
#pragma once

#include "geometry/morton.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

using geometry::finest_level;
using geometry::grid_point;
using geometry::grid_size;
using geometry::GridPoint;
using geometry::morton_key;

/// Numbers from `first` up to, but without, `last`.
struct IndexRange {
  std::size_t first, last;

  std::size_t size() const { return last - first; }
};

/// Cells of an octree: the Morton keys of their low corners, and their levels.
struct CellSpans {
  std::span<const std::uint64_t> keys;
  std::span<const std::uint8_t> levels;

  std::size_t size() const { return keys.size(); }
  CellSpans part(IndexRange range) const {
    return {keys.subspan(range.first, range.size()), levels.subspan(range.first, range.size())};
  }
};

/// The numbers that one rank gets where `count` things are divided evenly.
inline IndexRange even_part(std::size_t count, parallel::Rank rank, int ranks) {
  const auto r = static_cast<std::size_t>(rank), of = static_cast<std::size_t>(ranks);
  return {count * r / of, count * (r + 1) / of};
}

/// Octree subtrees that tile the root, in the order of the Morton curve. Each is owned by one rank, which
/// makes the leaves in it. A rank owns neighbours along the curve, with about as many cells as any other
/// rank. Every rank knows all subtrees. The field does not depend on them.
class Subtrees {
public:
  /// The root alone, owned by one rank. There is no communicator.
  Subtrees() = default;
  /// Each rank gives its own cells, in the order of their keys. A subtree holds at most `most` cells of all
  /// ranks, or only cells that are no smaller than it. Collective.
  Subtrees(const parallel::Communicator& communicator, CellSpans own, std::int64_t most);

  const parallel::Communicator& communicator() const { return _communicator; }
  parallel::Rank rank() const { return _rank; }
  int ranks() const { return static_cast<int>(_firsts.size()); }
  std::size_t count() const { return _keys.size(); }
  std::uint64_t key(std::size_t subtree) const { return _keys[subtree]; }
  int level(std::size_t subtree) const { return _levels[subtree]; }
  /// The subtree that holds the finest cell with this key.
  std::size_t find(std::uint64_t key) const {
    return static_cast<std::size_t>(std::upper_bound(_keys.begin(), _keys.end(), key) - _keys.begin()) - 1;
  }
  parallel::Rank owner(std::size_t subtree) const {
    return static_cast<parallel::Rank>(std::upper_bound(_firsts.begin(), _firsts.end(), subtree) -
                                       _firsts.begin()) -
           1;
  }
  IndexRange of_rank(parallel::Rank rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return {_firsts[r], r + 1 < _firsts.size() ? _firsts[r + 1] : count()};
  }

  /// Where the subtrees of a rank begin, or would begin if it had any.
  std::uint64_t first_key(parallel::Rank rank) const {
    const std::size_t subtree = _firsts[static_cast<std::size_t>(rank)];
    return subtree < count() ? _keys[subtree] : 1ULL << 3 * finest_level;
  }

private:
  void assign_to_ranks(std::span<const std::int64_t> weights, int ranks);

  parallel::Communicator _communicator;
  parallel::Rank _rank = 0;
  std::vector<std::uint64_t> _keys{0};
  std::vector<std::uint8_t> _levels{0};
  std::vector<std::size_t> _firsts{0};  // per rank
};

}  // namespace aeroloom::sizing
