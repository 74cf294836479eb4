/// Meshes as Medit files (GMF), which refine, Mmg, ParMmg and INRIA's tools read.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

struct MeditOptions {
  bool wide = false;  ///< version 4 even where version 3 suffices
};

/// Writes PATH, binary where it ends in .meshb and as text where it ends in .mesh, and beside it the names of
/// regions and patches (io/medit/medit_names.hpp). Keywords and widths follow libMeshb 7: version 3 (64-bit
/// positions and coordinates, 32-bit numbers), version 4 (64-bit numbers) where a count exceeds 2^31 - 1;
/// text says version 2 and has 17 digits. Vertices by number, reference 0; faces of all patches, those
/// between regions too, by patch, counter-clockwise seen from outside the fluid, reference patch + 1; cells
/// by part, reference region + 1. Prisms and pyramids have the corners of io/file_mesh.hpp. Left out: edges,
/// ridges, corners, geometry. Every rank writes its own part of the file through a buffer of 1 MiB.
/// Collective; the bytes depend on the parts alone. Throws CollectiveError (files); (input) where the name
/// ends otherwise.
void write_medit(const FileMesh& mesh, const std::string& path, const MeditOptions& options = {});

}  // namespace aeroloom::io
