/// Converts a mesh from one file format to another.
#pragma once

#include "io/write_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <optional>
#include <string>

namespace aeroloom::pipeline {

struct Conversion {
  std::string from, to;
  std::optional<io::FileFormat> format;  ///< of `to`; empty: by its extension
  io::WriteOptions options;
  double reynolds = 0, length = 0;  ///< of the flow, for settings of solvers; both or none (0)
};

/// Reads a mesh (io/read_mesh.hpp) and writes it (io/write_mesh.hpp), distributed over all ranks. Formats
/// without parts keep the order of points and cells; for formats with parts the mesh is cut along a
/// space-filling curve. Collective. Throws CollectiveError, std::invalid_argument for a name of no format.
void convert_file(const parallel::Communicator& communicator, const Conversion& conversion);

}  // namespace aeroloom::pipeline
