/// Points in messages.
#pragma once

#include "geometry/vec.hpp"

#include <string>

namespace aeroloom::geometry {

/// "(36.21, -0.02782, 6.727)".
std::string place_text(Vec3 p);

}  // namespace aeroloom::geometry
