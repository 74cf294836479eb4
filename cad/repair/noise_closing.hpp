/// How faces and edges that are noise close: vertices become one, edges are cut and laid on one another. Seen
/// by this folder only.
#pragma once

#include "cad/repair/edge_substitution.hpp"

namespace aeroloom::cad {

/// Faces and edges that are to be closed.
struct NoiseItems {
  TopTools_IndexedMapOfShape faces;  ///< narrower than the tolerance
  TopTools_IndexedMapOfShape edges;  ///< shorter than the tolerance
};

/// The substitution that closes them. Vertices of a noise face that are nearer than `tolerance` to another
/// part of its border are united with it, which cuts edges where they have no vertex; edges that run from the
/// same vertex to the same vertex, that near all along, become one, which has a parameter curve on each of
/// their faces. Vertices unite only as far as three tolerances. Throws CadError naming the place where that
/// is not enough.
Substitution plan_closing(const TopoDS_Shape& shape, const NoiseItems& items, double tolerance);

}  // namespace aeroloom::cad
