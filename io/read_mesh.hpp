/// Reading a mesh, whatever its format.
#pragma once

#include "io/raw_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// Reads a file by its extension: .vtu, .pvtu, .vtk, .vtkhdf, .msh, .ugrid (with the letters before it),
/// .su2, .su2b, .mesh, .meshb. Each rank reads its share where the format allows it. `parts` and the rest as
/// assemble() has it. Collective; throws CollectiveError (files where the file cannot be opened, input for
/// what is in it).
Assembled read_mesh(const SharedPath& file, std::int32_t parts);

/// The ends of paths that read_mesh() knows, each with its dot.
std::vector<std::string> readable_extensions();

/// The repairs of a file's mesh in words: "3 cells turned over, 10 points without a cell dropped, ...";
/// "nothing changed".
std::string describe(const Assembled& file);

}  // namespace aeroloom::io
