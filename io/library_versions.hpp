/// The libraries behind the file formats, for those who may not see them.
#pragma once

#include <string>

namespace aeroloom::io {

/// Of the libraries that are loaded, which may be newer than those compiled against.
std::string vtk_version();
std::string hdf5_version();

}  // namespace aeroloom::io
