/// Meshes from Medit files (GMF) of any origin.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Reads .meshb (versions 1 to 4, both byte orders: every rank its own share of each section) or .mesh (text:
/// rank 0 reads all); the first bytes decide. Cells of one reference are a region, faces of one reference a
/// patch, in ascending order of references; named by NAME.names where that is there
/// (io/medit/medit_names.hpp) and names all that are in use (otherwise it is left alone, with a warning),
/// else `region_REF` and `patch_REF`, a wall. Edges, ridges, corners, geometry and solutions are left out.
/// Throws CollectiveError (files) where the file cannot be read, (input) naming file and place: no such
/// format, a plane mesh, cut off, a count or position that the file has no room for, a section that comes
/// twice, hexahedra, curved cells, a number that is none, more than 65,536 references. Collective.
RawMesh read_medit(const SharedPath& file);

}  // namespace aeroloom::io
