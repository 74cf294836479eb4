/// The library of the forest, for those who may not see it.
#pragma once

#include <string>

namespace aeroloom::forest {

/// Of p4est, as it was compiled against.
std::string p4est_version();

}  // namespace aeroloom::forest
