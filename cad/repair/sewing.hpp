/// From faces with gaps to closed shells. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>

namespace aeroloom::cad {

/// Edges of one face only, seams and poles left out, in order.
std::vector<TopoDS_Edge> open_edges(const TopoDS_Shape& shape);

struct SewnShells {
  std::vector<TopoDS_Shell> shells;
  double gap = 0;  ///< the widest one that was closed
};

/// Sews faces with tolerances from 1e-7 to 1e-4 of their diagonal, none above `largest_tolerance`, until all
/// of them form closed shells; where strips are noise (noise.hpp), with less before, and without the strips.
/// Where none does it, planar openings are capped (plane_loops.hpp) at the smallest tolerance that leaves no
/// others. Labels follow; what was sewn, how far it moved and every cap are appended to `changes`. Throws
/// CadError listing the open edges.
SewnShells sew(const TopTools_IndexedMapOfShape& faces, double largest_tolerance, FaceLabels& labels,
               Changes& changes);

}  // namespace aeroloom::cad
