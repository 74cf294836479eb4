/// Points by key, spread over the ranks by ranges of keys. Internal to io/.
#pragma once

#include "mesh/piece.hpp"
#include "parallel/communicator.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::io {

/// A point under a key: an id of a file, or a number.
struct KeyedPoint {
  mesh::GlobalIndex key = 0;
  std::array<double, 3> at{};
};

/// Which rank keeps which keys: rank r those from first[r] to first[r + 1] - 1.
struct KeyRanges {
  std::vector<mesh::GlobalIndex> first;  ///< (size + 1)
  parallel::Rank rank_of(mesh::GlobalIndex key) const;
};
/// Ranges of equal width below `limit`.
KeyRanges even_ranges(int ranks, mesh::GlobalIndex limit);
/// Ranges below `limit` that share out the keys of all ranks: even ones where keys are dense, otherwise such
/// that a few keys far from the others change nothing (splitters of samples: Shi, Schaeffer, J. Parallel
/// Distrib. Comput. 14, 1992, doi:10.1016/0743-7315(92)90075-X). Collective.
KeyRanges fair_ranges(const parallel::Communicator& communicator, std::vector<mesh::GlobalIndex> keys,
                      mesh::GlobalIndex limit);

class PointStore {
public:
  /// Takes points of any rank to those of their keys. A key may come several times; the first in the order of
  /// ranks stays, and `clash` becomes the lowest key whose points differ in a bit (-1: none). Collective.
  PointStore(const parallel::Communicator& communicator, KeyRanges ranges, std::vector<KeyedPoint> points);

  /// The points of ascending keys, each once; `missing` is the lowest key, asked for anywhere, that there is
  /// not (-1: none): the points are then worth nothing. Collective.
  struct Found {
    std::vector<std::array<double, 3>> points;
    mesh::GlobalIndex missing = -1;
  };
  Found fetch(const std::vector<mesh::GlobalIndex>& keys) const;

  /// Numbers the points that anyone names among `used`, in the order of their keys, and drops the others;
  /// their numbers become their keys. Returns the numbers of `used` and of `others` (both as in fetch; -1
  /// where there is no such point any more), and which of `used` other ranks named too. Collective.
  struct Numbers {
    std::vector<mesh::GlobalIndex> used, others;
    std::vector<std::uint8_t> shared;
  };
  Numbers number(const std::vector<mesh::GlobalIndex>& used, const std::vector<mesh::GlobalIndex>& others);

  mesh::GlobalIndex clash() const { return _clash; }
  mesh::GlobalIndex count() const { return _count; }               ///< of all ranks
  const std::vector<KeyedPoint>& mine() const { return _points; }  ///< ascending key

private:
  struct Question {
    mesh::GlobalIndex key;
    std::int64_t rank;
  };
  std::vector<Question> ask(const std::vector<mesh::GlobalIndex>& keys) const;
  std::int64_t position(mesh::GlobalIndex key) const;
  std::vector<mesh::GlobalIndex> answer(const std::vector<Question>& questions,
                                        const std::vector<mesh::GlobalIndex>& numbers) const;

  parallel::Communicator _communicator;
  KeyRanges _ranges;
  std::vector<KeyedPoint> _points;
  mesh::GlobalIndex _clash = -1, _count = 0;
};

/// The lowest of what the ranks say, -1 standing for nothing. Collective.
mesh::GlobalIndex lowest_of_all(const parallel::Communicator& communicator, mesh::GlobalIndex mine);

/// Which rank has part p of `parts`.
inline parallel::Rank rank_of_part(std::int32_t part, std::int32_t parts, int ranks) {
  return static_cast<parallel::Rank>(static_cast<std::int64_t>(part) * ranks / parts);
}

}  // namespace aeroloom::io
