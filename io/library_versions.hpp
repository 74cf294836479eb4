/// Versions of the libraries behind the file formats.
#pragma once

#include <string>

namespace aeroloom::io {

/// The version that is loaded; it may be newer than the one at compile time.
std::string vtk_version();
std::string hdf5_version();

}  // namespace aeroloom::io
