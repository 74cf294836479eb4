/// Second pass over the CAD library's triangulation of a face. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// Divides and reconnects facets until they follow the surface: the CAD library bounds neither the turn
/// between neighbours nor, where parameters are badly scaled, the distance, and folds facets at sharp leading
/// edges. Longest sides are halved (Rivara, Int. J. Numer. Meth. Engng 20, 1984, doi:10.1002/nme.1620200412)
/// and sides flipped to the Delaunay diagonal of space, as long as triangles keep their orientation in
/// parameters. `facets` is counter-clockwise in parameters here. Sides shorter than a tenth of `deflection`
/// are not halved for the angle's sake: a kink of the surface would go on for ever. Both coedges of a seam
/// are divided alike.
void refine_facets(const Model& model, FaceId id, double deflection, double angle, Facets& facets);

/// A pole is one point of space and a line in parameters. The CAD library puts no vertices on that line, so
/// that facets reach the pole at parameters far from their own, and what is interpolated on them lies
/// elsewhere. This gives each facet a vertex of the pole at its own parameters, with facets of no area
/// between them. Where that would turn a facet over in parameters the pole stays as it is. `facets` is
/// counter-clockwise in parameters here.
void spread_poles(const Model& model, FaceId id, Facets& facets);

/// Takes out the points that no triangle and no boundary line has; the others keep their order.
void drop_unused_points(Facets& facets);

}  // namespace aeroloom::cad
