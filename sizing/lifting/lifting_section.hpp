/// Sections of a skin by planes, and where they lead round a nose.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/features/proximity.hpp"

#include <optional>
#include <vector>

namespace aeroloom::sizing {

/// A plane through a place of a trailing edge; `ahead` is a unit vector in it that leads into the body.
struct CuttingPlane {
  geometry::Vec3 origin, normal, ahead;
};

/// The nose of a section, seen from the plane's origin.
struct Nose {
  geometry::Vec3 place;  ///< farthest from the origin, on the CAD surface
  double thickness = 0;  ///< of the section across the line from the origin to the place
};

/// Of what hangs together with the facets at the origin: parts as near as `gap`, or as a two-hundredth of the
/// whole section, do. Nothing where no facet is met.
std::optional<Nose> find_nose(const cad::Model& model, const std::vector<Wall>& skin,
                              const CuttingPlane& plane, double gap);

/// The place of the section farthest ahead within `reach` of a guess. Nothing where no facet is that near.
std::optional<geometry::Vec3> find_nose_near(const cad::Model& model, const std::vector<Wall>& skin,
                                             const CuttingPlane& plane, geometry::Vec3 guess, double reach);

}  // namespace aeroloom::sizing
