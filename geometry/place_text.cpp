#include "geometry/place_text.hpp"

#include <fmt/format.h>

namespace aeroloom::geometry {

std::string place_text(Vec3 p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

}  // namespace aeroloom::geometry
