/// Data of plan_closing(): edges cut into pieces, and vertices that are united. For noise_closing.cpp only.
#pragma once

#include "geometry/vec.hpp"

#include <utility>
#include <vector>

#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

using geometry::Vec3;

/// A cut of an edge.
struct EdgeCut {
  double parameter;
  int vertex;
};
/// An interval of an edge between two vertices or cuts.
struct EdgePiece {
  EdgePiece(int edge, double first, double last, int start, int end)
      : edge(edge), first(first), last(last), start(start), end(end) {}
  int edge;
  double first, last;
  int start, end;        // representatives of the vertices
  double length = 0;     // only computed where it is needed
  int like = -1;         // the piece that replaces this one, or itself
  bool against = false;  // opposite direction to that piece
  TopoDS_Edge made = {};
};

/// Sets of united vertices. A set stays small: its box is bounded.
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
  /// The middle of a set, and the largest distance of its vertices from there.
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
