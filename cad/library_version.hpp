/// The version of the CAD library.
#pragma once

#include <string>

namespace aeroloom::cad {

/// The version of OpenCASCADE at compile time.
std::string opencascade_version();

}  // namespace aeroloom::cad
