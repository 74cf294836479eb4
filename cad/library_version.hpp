/// The CAD library, for those who may not see it.
#pragma once

#include <string>

namespace aeroloom::cad {

/// Of OpenCASCADE, as it was compiled against.
std::string opencascade_version();

}  // namespace aeroloom::cad
