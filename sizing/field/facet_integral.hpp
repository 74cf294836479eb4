/// The number of elements for which a flat facet has room.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <array>

namespace aeroloom::sizing {

/// The integral of 1/h^2 over the facet. Long facets are cut to a few sizes first. The number of triangles
/// there is 4 / sqrt(3) times the integral.
double integrate_facet(const SizeField& field, const std::array<geometry::Vec3, 3>& facet);

}  // namespace aeroloom::sizing
