#include "geometry/library_version.hpp"

#include <CGAL/version.h>

namespace aeroloom::geometry {

std::string cgal_version() {
  return CGAL_VERSION_STR;
}

}  // namespace aeroloom::geometry
