/// The libraries behind messages and the log, for those who may not see them.
#pragma once

#include <string>

namespace aeroloom::parallel {

/// The message passing library that is loaded, as it names itself: "Open MPI v4.1.4".
std::string mpi_version();
/// Of spdlog, as it was compiled against.
std::string spdlog_version();

}  // namespace aeroloom::parallel
