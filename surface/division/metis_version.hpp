/// The partitioner, for those who may not see it.
#pragma once

#include <string>

namespace aeroloom::partition {

/// Of METIS, as it was compiled against.
std::string metis_version();

}  // namespace aeroloom::partition
