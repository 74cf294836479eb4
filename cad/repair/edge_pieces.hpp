/// Edges cut into pieces, some of which take the place of others. Seen by this folder only.
#pragma once

#include "geometry/vec.hpp"

#include <BRep_Tool.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

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

inline Vec3 place_of_vertex(const TopoDS_Vertex& vertex) {
  const gp_Pnt p = BRep_Tool::Pnt(vertex);
  return {p.X(), p.Y(), p.Z()};
}

}  // namespace aeroloom::cad
