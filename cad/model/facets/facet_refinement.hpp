/// Improves the CAD library's triangulation of a face. Internal to cad/model/.
///
/// In these functions triangles are counter-clockwise in the parameter plane.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// Refines the triangulation until it follows the surface. The CAD library does not bound the angle between
/// neighbours, and sometimes not the distance; it folds triangles at sharp leading edges. Longest sides are
/// bisected (Rivara, Int. J. Numer. Meth. Engng 20, 1984, doi:10.1002/nme.1620200412). Sides are flipped to
/// the Delaunay diagonal in space as long as triangles keep their orientation in parameters. Sides shorter
/// than a tenth of `deflection` are not divided because of angles. Both coedges of a seam are divided alike.
void refine_facets(const Model& model, FaceId id, double deflection, double angle, Facets& facets);

/// Gives each triangle at a pole a vertex of its own there. A pole is one point in space and a line in
/// parameters. The CAD library puts no vertices inside that line, so parameters interpolated in triangles at
/// the pole would be wrong. Triangles without area lie between the new vertices. A pole stays as it is if a
/// triangle would be turned over in parameters.
void spread_poles(const Model& model, FaceId id, Facets& facets);

/// Removes points that no triangle and no boundary line uses. The others keep their order.
void drop_unused_points(Facets& facets);

}  // namespace aeroloom::cad
