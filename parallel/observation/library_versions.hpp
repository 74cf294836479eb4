/// Versions of the libraries that parallel/ uses, for the report.
#pragma once

#include <string>

namespace aeroloom::parallel {

/// The loaded MPI library in its own words: "Open MPI v4.1.4".
std::string mpi_version();
/// The version of spdlog at compile time.
std::string spdlog_version();

}  // namespace aeroloom::parallel
