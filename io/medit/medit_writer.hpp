/// Writes Medit files (GMF), which refine, Mmg, ParMmg and INRIA's tools read.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

struct MeditOptions {
  bool wide = false;  ///< version 4 even where version 3 suffices
};

/// Writes a mesh to `path`: binary for the extension .meshb, text for .mesh. The names of regions and patches
/// go into a file beside it (io/medit/medit_names.hpp). Keywords and widths follow libMeshb 7: version 3 with
/// 64-bit positions and coordinates and 32-bit numbers, or version 4 with 64-bit numbers where a count
/// exceeds 2^31 - 1. Text files say version 2 and have 17 digits. Vertices come by number, with reference 0.
/// Faces of all patches (also between regions) come by patch, with reference patch + 1, counter-clockwise
/// seen from outside the fluid. Cells come by part, with reference region + 1. Edges, ridges, corners and
/// geometry are left out. Every rank writes its items through a buffer of 1 MiB. The bytes depend on the
/// parts alone. Collective. Throws CollectiveError: (files) where it cannot be written, (input) for other
/// extensions.
void write_medit(const FileMesh& mesh, const std::string& path, const MeditOptions& options = {});

}  // namespace aeroloom::io
