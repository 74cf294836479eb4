#include "cad/library_version.hpp"

#include <Standard_Version.hxx>

namespace aeroloom::cad {

std::string opencascade_version() {
  return OCC_VERSION_COMPLETE;
}

}  // namespace aeroloom::cad
