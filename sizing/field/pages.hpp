/// How the root cube of an octree is shared among ranks.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/field/morton.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// A range of numbers.
struct IndexRange {
  std::size_t first, last;

  std::size_t size() const { return last - first; }
};

/// Cells of an octree by the Morton keys of their low corners, and their levels.
struct CellSpans {
  std::span<const std::uint64_t> keys;
  std::span<const std::uint8_t> levels;

  std::size_t size() const { return keys.size(); }
  CellSpans part(IndexRange range) const {
    return {keys.subspan(range.first, range.size()), levels.subspan(range.first, range.size())};
  }
};

/// The part of a rank where ranks have about as many of `count` things each.
inline IndexRange even_part(std::size_t count, parallel::Rank rank, int ranks) {
  const auto r = static_cast<std::size_t>(rank), of = static_cast<std::size_t>(ranks);
  return {count * r / of, count * (r + 1) / of};
}

/// Cubes that tile the root, in their order along the Morton curve, each with the rank that makes what lies
/// in it: neighbours along the curve, about as much for each. Which there are is known on every rank, and
/// does not count for what is made. They hold the communicator of those ranks.
class Pages {
public:
  /// The root alone, on one rank; without a communicator.
  Pages() = default;
  /// Cells of all ranks, each rank's own in the order of their keys, in cubes that hold at most `most` or
  /// cells no smaller than they are. Collective.
  Pages(const parallel::Communicator& communicator, CellSpans own, std::int64_t most);

  const parallel::Communicator& communicator() const { return _communicator; }
  parallel::Rank rank() const { return _rank; }
  int ranks() const { return static_cast<int>(_firsts.size()); }
  std::size_t count() const { return _keys.size(); }
  std::uint64_t key(std::size_t page) const { return _keys[page]; }
  int level(std::size_t page) const { return _levels[page]; }
  /// The one that holds the finest cell with this key.
  std::size_t find(std::uint64_t key) const {
    return static_cast<std::size_t>(std::upper_bound(_keys.begin(), _keys.end(), key) - _keys.begin()) - 1;
  }
  parallel::Rank owner(std::size_t page) const {
    return static_cast<parallel::Rank>(std::upper_bound(_firsts.begin(), _firsts.end(), page) -
                                       _firsts.begin()) -
           1;
  }
  IndexRange of_rank(parallel::Rank rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return {_firsts[r], r + 1 < _firsts.size() ? _firsts[r + 1] : count()};
  }

  /// Where the pages of a rank begin, or would if it had any.
  std::uint64_t first_key(parallel::Rank rank) const {
    const std::size_t page = _firsts[static_cast<std::size_t>(rank)];
    return page < count() ? _keys[page] : 1ULL << 3 * finest_level;
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
