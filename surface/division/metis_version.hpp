/// The version of METIS, for folders that may not include its header.
#pragma once

#include <string>

namespace aeroloom::partition {

/// The version that the program was compiled against.
std::string metis_version();

}  // namespace aeroloom::partition
