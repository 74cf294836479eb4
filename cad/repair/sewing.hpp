/// Sews faces with gaps into closed shells. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>

namespace aeroloom::cad {

/// Edges of one face only, without seams and poles, in order.
std::vector<TopoDS_Edge> open_edges(const TopoDS_Shape& shape);

/// Whether each connected part of the faces is a sheet: it is open wider than half of its area, and what
/// closes it would be no opening of a body.
bool are_sheets(const TopTools_IndexedMapOfShape& faces);

struct SewnShells {
  std::vector<TopoDS_Shell> shells;
  double gap = 0;  ///< width of the widest gap that was closed
};

/// Sews faces until all of them form closed shells. Tolerances grow from 1e-7 to 1e-4 of the diagonal, up to
/// `largest_tolerance`. If some faces are noise (noise.hpp), smaller tolerances are tried too, and sewing
/// without these faces. If no tolerance succeeds, planar openings are capped (plane_loops.hpp). Labels
/// follow. Tolerance, gaps and caps are appended to `changes`. Throws CadError that lists the open edges. If
/// there are closed bodies beside these faces, or among them, it names the faces that may be left out.
SewnShells sew(const TopTools_IndexedMapOfShape& faces, double largest_tolerance, FaceLabels& labels,
               Changes& changes, bool beside_bodies = false);

}  // namespace aeroloom::cad
