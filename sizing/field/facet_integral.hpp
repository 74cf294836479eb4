/// How many elements a flat facet has room for.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <array>

namespace aeroloom::sizing {

/// Integral of 1/h^2 over the facet, by its parts that are at most a few sizes large; 4 / sqrt(3) of it is
/// the number of triangles there.
double integrate_facet(const SizeField& field, const std::array<geometry::Vec3, 3>& facet);

}  // namespace aeroloom::sizing
