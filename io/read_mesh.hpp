/// Reads a mesh in any known format.
#pragma once

#include "io/raw_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// Reads a file by its extension: .vtu, .pvtu, .vtk, .vtkhdf, .msh, .ugrid (with the letters before it),
/// .su2, .su2b, .mesh, .meshb. Each rank reads a range of the items if the format allows it. `parts`: as for
/// assemble(). Collective. Throws CollectiveError: (files) where the file cannot be opened, (input) for its
/// content.
Assembled read_mesh(const SharedPath& file, std::int32_t parts);

/// The extensions that read_mesh() knows, with their dots.
std::vector<std::string> readable_extensions();

/// The corrections in words: "3 cells turned over, 10 points without a cell dropped, ...", or "nothing to
/// mend".
std::string describe(const Assembled& file);

}  // namespace aeroloom::io
