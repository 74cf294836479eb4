/// Sections of a skin by planes, and the nose of each section.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/features/proximity.hpp"

#include <optional>
#include <vector>

namespace aeroloom::sizing {

/// A plane through a place of a trailing edge. `ahead`: a unit vector in the plane that leads into the body.
struct CuttingPlane {
  geometry::Vec3 origin, normal, ahead;
};

/// The nose of a section: its point farthest from the origin of the plane.
struct Nose {
  geometry::Vec3 place;  ///< farthest from the origin, on the CAD surface
  double thickness = 0;  ///< of the section across the line from the origin to the place
};

/// The nose of the part of a section that is connected to the facets at the origin. Parts count as connected
/// up to the larger of `gap` and 0.005 of the section's extent. Returns nothing if the plane meets no facet.
std::optional<Nose> find_nose(const cad::Model& model, const std::vector<ModelFacet>& skin,
                              const CuttingPlane& plane, double gap);

/// The point of the section within `reach` of a guess that is farthest from the plane's origin. Returns
/// nothing if no facet is so near.
std::optional<geometry::Vec3> find_nose_near(const cad::Model& model, const std::vector<ModelFacet>& skin,
                                             const CuttingPlane& plane, geometry::Vec3 guess, double reach);

}  // namespace aeroloom::sizing
