/// A text file beside a Medit mesh with the names of regions and patches, which Medit cannot hold.
#pragma once

#include "io/file_mesh.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace aeroloom::io {

/// The meaning of references (integer labels): of cells the region, of faces the patch.
struct MeditNames {
  std::map<std::int64_t, std::string> regions;
  std::map<std::int64_t, mesh::Patch> patches;
};

/// The path of the names of a mesh: wing.names for wing.meshb.
std::string medit_names_path(const std::string& mesh_path);

/// One line for each region (`tetrahedra 1 fluid`) and patch (`triangles 3 upper wing wall`): its first
/// shape, its reference, its name, and the type of patches. In names a backslash becomes \\; control
/// characters, and blanks at either end, become \xHH.
std::string medit_names_text(const FileMesh& mesh);

/// Reads such a text; lines may be empty or begin with #. Throws std::runtime_error with the line for an
/// unknown shape or type, and for a reference or name that is missing or repeated. `path`: for messages.
MeditNames parse_medit_names(const std::string& text, const std::string& path);

}  // namespace aeroloom::io
