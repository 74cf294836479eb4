/// Writes UGRID files with their .mapbc, which FUN3D, refine, Flow360 and USM3D read.
///
/// The path tells the kind (io/ugrid/ugrid_format.hpp): .lb8.ugrid, .b8.ugrid, or .lb8l.ugrid, .b8l.ugrid
/// with 64-bit integers. Points come by number; cells come by part and shape. Triangles, then
/// quadrilaterals, of all patches on the boundary come by patch id, and point into the fluid. Ids are 1 ... N
/// in the order of the patches that have faces. NAME.mapbc lists id, FUN3D's number of the condition and
/// name; blanks and `/ , ; * ' "` in names become `_`, and repeated names get `_2`, ... A symmetry plane is
/// normal to an axis if its extent along it is below 1e-9 of its size. Parts, regions and the faces between
/// regions are left out: UGRID has no place for them.
#pragma once

#include "io/boundary_patches.hpp"
#include "io/file_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// The bytes depend on the parts alone. Collective. Throws CollectiveError: (input) where the suffix is
/// unknown or its integers are too small for the mesh; (files) where the file cannot be written.
void write_ugrid(const FileMesh& mesh, const std::string& path);

/// The names of the patches in the .mapbc file, all different.
std::vector<std::string> names_in_mapbc(const FileMesh& mesh, const BoundaryPatches& patches);

}  // namespace aeroloom::io
