/// Solids of the CAD library as closed triangles. Seen by cad/ only.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/model/named_shape.hpp"

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

struct FacetLimits {
  double deflection = 0;  ///< of a triangle from its face
  double angle = 0;       ///< between neighbouring triangles, radians
};

struct ShapeFacets {
  FacetSoup soup;  ///< closed: neighbouring faces share the points of their edges; a group for each face
  double deviation = 0;  ///< the farthest that the middle of a triangle is off its face
};

/// Finer than the limits where triangles would cross. Points of the soup that are equal are one. Throws
/// CadError where no triangulation closes without crossings.
ShapeFacets facets_of(const TopoDS_Solid& solid, const FaceLabels& labels, const FacetLimits& limits);

}  // namespace aeroloom::cad
