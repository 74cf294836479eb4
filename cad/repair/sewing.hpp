/// Sews faces with gaps into closed shells. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/half_shells.hpp"
#include "cad/repair/open_faces.hpp"

#include <optional>
#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>

namespace aeroloom::cad {

/// Whether each connected part of the faces is a sheet: it is open wider than half of its area, and what
/// closes it would be no opening of a body.
bool are_sheets(const TopTools_IndexedMapOfShape& faces);

struct SewnShells {
  std::vector<TopoDS_Shell> shells;
  double gap = 0;                       ///< width of the widest gap that was closed
  std::optional<AxisPlane> plane = {};  ///< of symmetry, if it closed them
};

struct SewingOptions {
  double largest_tolerance = 0;
  bool beside_bodies = false;          ///< there are closed bodies beside these faces
  std::optional<HalfPlane> half = {};  ///< the plane of symmetry of a half model
  OpeningRules* openings = nullptr;    ///< for what is open; null: none
};

/// Sews faces until all of them form closed shells. Tolerances grow from 1e-7 to 1e-4 of the diagonal, up to
/// `largest_tolerance`. If some faces are noise (noise.hpp), smaller tolerances are tried too, and sewing
/// without these faces. If no tolerance succeeds, planar openings are capped (plane_loops.hpp), and open
/// halves closed by their plane of symmetry (half_shells.hpp). Labels follow. Tolerance, gaps, caps and all
/// else that was closed are appended to `changes`. Throws CadError that lists the open edges. If there are
/// closed bodies beside these faces, or among them, it names the faces that may be left out.
SewnShells sew(const TopTools_IndexedMapOfShape& faces, const SewingOptions& options, FaceLabels& labels,
               Changes& changes);

}  // namespace aeroloom::cad
