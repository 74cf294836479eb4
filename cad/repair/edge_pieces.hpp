/// The workings of plan_closing(): edges cut into pieces, and vertices that become one. Seen by
/// noise_closing.cpp only.
#pragma once

#include "geometry/vec.hpp"

#include <utility>
#include <vector>

#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

using geometry::Vec3;

/// Where an edge is cut.
struct EdgeCut {
  double parameter;
  int vertex;
};
/// A stretch of an edge between vertices or cuts.
struct EdgePiece {
  EdgePiece(int edge, double first, double last, int start, int end)
      : edge(edge), first(first), last(last), start(start), end(end) {}
  int edge;
  double first, last;
  int start, end;        // vertices' roots
  double length = 0;     // where it matters
  int like = -1;         // the piece that takes its place; itself
  bool against = false;  // runs against that one
  TopoDS_Edge made = {};
};

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
