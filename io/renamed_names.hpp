/// Names of patches and regions that a format cannot hold as they are.
#pragma once

#include "io/file_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// A name of the mesh, and what it is in a file.
struct RenamedName {
  std::string name, in_file;
};

/// By format, in the order of patches, then of regions. Only patches and regions that are in the file count.
std::vector<RenamedName> renamed_in_cgns(const FileMesh& mesh);
std::vector<RenamedName> renamed_in_ugrid(const FileMesh& mesh);
std::vector<RenamedName> renamed_in_su2(const FileMesh& mesh);
std::vector<RenamedName> renamed_in_msh(const FileMesh& mesh);
std::vector<RenamedName> renamed_in_openfoam(const FileMesh& mesh);

}  // namespace aeroloom::io
