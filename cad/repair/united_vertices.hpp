/// Vertices that become one where they are near. Seen by this folder only.
#pragma once

#include "geometry/vec.hpp"

#include <utility>
#include <vector>

namespace aeroloom::cad {

using geometry::Vec3;

/// Vertices by number, united as far as their boxes stay small.
class UnitedVertices {
public:
  int add(Vec3 place) {
    const int number = static_cast<int>(_parents.size());
    _parents.push_back(number);
    _places.push_back(place);
    _boxes.emplace_back().add(place);
    return number;
  }
  int root(int v) const {
    while (_parents[v] != v) v = _parents[v];
    return v;
  }
  Vec3 place(int v) const { return _places[v]; }
  int count() const { return static_cast<int>(_parents.size()); }
  bool unite(int a, int b, double widest) {
    a = root(a), b = root(b);
    if (a == b) return true;
    geometry::Box both = _boxes[a];
    both.add(_boxes[b].low);
    both.add(_boxes[b].high);
    if (both.diagonal() > widest) return false;
    if (a > b) std::swap(a, b);
    _parents[b] = a;
    _boxes[a] = both;
    return true;
  }
  /// The middle of those united, and how far they are from it.
  std::pair<Vec3, double> middle(int root) const {
    const Vec3 at = _boxes[root].center();
    return {at, 0.5 * _boxes[root].diagonal()};
  }

private:
  std::vector<int> _parents;
  std::vector<Vec3> _places;
  std::vector<geometry::Box> _boxes;
};

}  // namespace aeroloom::cad
