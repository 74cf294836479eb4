#include "surface/division/metis_version.hpp"

#include <metis.h>

namespace aeroloom::partition {

std::string metis_version() {
  return std::to_string(METIS_VER_MAJOR) + "." + std::to_string(METIS_VER_MINOR) + "." +
         std::to_string(METIS_VER_SUBMINOR);
}

}  // namespace aeroloom::partition
