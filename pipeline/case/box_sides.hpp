/// Names of the sides of a fluid's box in a case about bodies.
#pragma once

#include "cad/model/model.hpp"

#include <string>

namespace aeroloom::cases {

/// The end of a message about a name or pattern that no face has: that the solids were taken as bodies, if
/// the pattern names a side of a fluid's box ("xmin" to "zmax") and the program added a far field. Otherwise
/// empty.
std::string hint_on_box_sides(const cad::Model& model, const std::string& pattern);

}  // namespace aeroloom::cases
