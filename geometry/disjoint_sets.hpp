/// Disjoint sets of numbers that are united one pair at a time (Tarjan, J. ACM 22, 1975,
/// doi:10.1145/321879.321884).
#pragma once

#include <concepts>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace aeroloom::geometry {

/// The lowest number of a set represents it, so results do not depend on the order of unions.
template <std::signed_integral Index>
class DisjointSets {
public:
  /// `count` sets of one number each, from 0.
  explicit DisjointSets(std::size_t count) : _parent(count) {
    std::iota(_parent.begin(), _parent.end(), Index{0});
  }

  std::size_t size() const { return _parent.size(); }
  /// The lowest number of the set of i. Shortens the path for later calls.
  Index root(Index i) {
    while (_parent[i] != i) i = _parent[i] = _parent[_parent[i]];
    return i;
  }
  void unite(Index a, Index b) {
    a = root(a), b = root(b);
    if (a > b) std::swap(a, b);
    _parent[b] = a;
  }

private:
  std::vector<Index> _parent;
};

}  // namespace aeroloom::geometry
