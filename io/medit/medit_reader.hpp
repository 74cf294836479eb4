/// Reads Medit files (GMF) of any origin.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Reads binary files (.meshb, versions 1 to 4, both byte orders) and text (.mesh); the first bytes decide.
/// Every rank reads a range of each section of a binary file; rank 0 reads text. The cells of one reference
/// are a region, the faces of one reference a patch, by ascending reference. NAME.names
/// (io/medit/medit_names.hpp) names them if it has all references in use; otherwise it is ignored with a
/// warning. Without names they are `region_REF`, and `patch_REF`, a wall. Edges, ridges, corners, geometry
/// and solutions are left out. Collective. Throws CollectiveError: (files) where the file cannot be read;
/// (input) with the place for a wrong format, two dimensions, damage, repeated sections, polyhedra, curved
/// cells, and more than 65,536 references.
RawMesh read_medit(const SharedPath& file);

}  // namespace aeroloom::io
