/// Reads UGRID files: .lb8.ugrid, .b8.ugrid, .lb8l.ugrid, .b8l.ugrid, .lb8.ugrid64, .b8.ugrid64.
///
/// Every rank reads its range of points, faces and cells. The patches are the ids of the faces, ascending.
/// NAME.mapbc beside NAME.lb8.ugrid gives names and conditions if it has the same ids; otherwise it is
/// ignored with a warning. Without names a patch is `patch_ID`, a wall. Repeated names get `_ID` at their
/// end. The mesh has one region, `fluid`. Optional records of AFLR after the cells are left out.
#pragma once

#include "io/raw_mesh.hpp"
namespace aeroloom::io {

/// Collective. Throws CollectiveError with the byte, or the line of the .mapbc: (input) for counts
/// that the file is too short for, points out of range, and coordinates that are no numbers; (files) where it
/// cannot be read.
RawMesh read_ugrid(const SharedPath& file);

}  // namespace aeroloom::io
