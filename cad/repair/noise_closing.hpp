/// Plans how noise faces and noise edges are closed. Internal to cad/repair/.
#pragma once

#include "cad/repair/edge_substitution.hpp"

namespace aeroloom::cad {

/// Faces and edges to close.
struct NoiseItems {
  TopTools_IndexedMapOfShape faces;  ///< narrower than the tolerance
  TopTools_IndexedMapOfShape edges;  ///< shorter than the tolerance
};

/// Plans the substitution that closes the items. A vertex of a noise face is united with the opposite side of
/// the face if it is nearer than `tolerance`. That side is cut there if it has no vertex. Edges that then run
/// side by side between the same vertices become one, with a parameter curve on each of their faces. United
/// vertices lie within three tolerances. Throws CadError that names the place if that is not enough.
Substitution plan_closing(const TopoDS_Shape& shape, const NoiseItems& items, double tolerance);

}  // namespace aeroloom::cad
