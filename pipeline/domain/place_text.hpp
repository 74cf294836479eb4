/// Points in texts.
#pragma once

#include "geometry/vec.hpp"

#include <string>

#include <fmt/format.h>

namespace aeroloom::domain {

/// "(36.21, -0.02782, 6.727)".
inline std::string place(geometry::Vec3 p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

}  // namespace aeroloom::domain
