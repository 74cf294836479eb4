/// The fluid around half bodies of triangles. Internal to cad/faceted/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_plane.hpp"
#include "cad/model/model_data.hpp"
#include "cad/repair/change.hpp"

#include <cstddef>
#include <vector>

namespace aeroloom::cad {

/// The boundary of the fluid in a half far field, all of triangles.
struct HalfFluid {
  FacetComplex complex;         ///< one region
  std::vector<char> far_field;  ///< per face: of the far field, the plane of symmetry included
  double outer = 0;             ///< volume inside the far field
  double bodies = 0;            ///< of the bodies in it, and of cavities that they enclose with the plane
};

/// Puts `walls`, the outer walls of closed halves as the fluid sees them, into a half far field. Their
/// triangles on the plane go; the plane takes their outlines as holes. The far field is made by the CAD
/// library and triangulated; coordinates on the plane are exact. What the plane closes inside of a body does
/// not reach the fluid. Lengths are in the unit at hand (library_unit.hpp). Throws CadError.
HalfFluid surround_half_facets(const FacetComplex& walls, const FarFieldOptions& options,
                               const FacetPlane& plane, double feature_angle, Changes& changes);

/// Marks the tags of far field and plane as such.
void tag_half_fluid(const HalfFluid& fluid, std::vector<FaceTag>& tags);

}  // namespace aeroloom::cad
