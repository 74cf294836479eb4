#include "volume/lattice/p4est_version.hpp"

#include <p4est_config.h>

namespace aeroloom::forest {

std::string p4est_version() {
  return P4EST_PACKAGE_VERSION;
}

}  // namespace aeroloom::forest
