/// The leaves of an octree as flat arrays.
#pragma once

#include "geometry/morton.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace aeroloom::forest {

/// Leaves in the order of the Morton curve.
struct Octants {
  std::vector<std::uint64_t> keys;   ///< Morton keys of the low corners, ascending
  std::vector<std::uint8_t> levels;  ///< 0: the root; geometry::finest_level: the finest

  std::size_t size() const { return keys.size(); }
  /// The index of the leaf that contains the finest cube with this key; -1: none does.
  std::int64_t find(std::uint64_t key) const {
    const auto after = std::upper_bound(keys.begin(), keys.end(), key);
    if (after == keys.begin()) return -1;
    const std::int64_t i = after - keys.begin() - 1;
    return (key - keys[i]) >> 3 * (geometry::finest_level - levels[i]) == 0 ? i : -1;
  }
  void add(std::uint64_t key, int level) {
    keys.push_back(key);
    levels.push_back(static_cast<std::uint8_t>(level));
  }
};

}  // namespace aeroloom::forest
