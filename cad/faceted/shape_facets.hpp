/// Triangulates CAD solids into closed soups. Internal to cad/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/model/named_shape.hpp"

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

struct FacetLimits {
  double deflection = 0;  ///< distance from triangle to face
  double angle = 0;       ///< between neighbouring triangles, radians
};

struct ShapeFacets {
  FacetSoup soup;        ///< closed: neighbouring faces share points; one group per face
  double deviation = 0;  ///< largest distance from the middle of a triangle to its face
};

/// Triangulates finer than the limits where triangles would cross. Equal points are one. Throws CadError if
/// no triangulation is closed and free of crossings.
ShapeFacets facets_of(const TopoDS_Solid& solid, const FaceLabels& labels, const FacetLimits& limits);

}  // namespace aeroloom::cad
