/// The version of p4est, for folders that may not include p4est.
#pragma once

#include <string>

namespace aeroloom::forest {

/// The version that the program was compiled with.
std::string p4est_version();

}  // namespace aeroloom::forest
