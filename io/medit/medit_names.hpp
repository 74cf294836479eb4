/// Names of regions and patches, which the Medit format has no place for, in a text file beside the mesh.
#pragma once

#include "io/file_mesh.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace aeroloom::io {

/// The regions and patches that references stand for: of cells of all shapes, and of faces of all shapes.
struct MeditNames {
  std::map<std::int64_t, std::string> regions;
  std::map<std::int64_t, mesh::Patch> patches;
};

/// The file of names of a mesh: wing.meshb has wing.names.
std::string medit_names_path(const std::string& mesh_path);

/// One line for each region, as `tetrahedra 1 fluid`, and for each patch, as `triangles 3 upper wing wall`:
/// the first shape that it has, its reference, its name, of patches the type. In names a backslash is written
/// \\, a control character or a blank at either end \xHH.
std::string medit_names_text(const FileMesh& mesh);

/// Reads such a text; lines may be empty or begin with #. Throws std::runtime_error with the line: no such
/// shape or type, no reference or name, a reference that comes twice. `path` is for messages.
MeditNames parse_medit_names(const std::string& text, const std::string& path);

}  // namespace aeroloom::io
