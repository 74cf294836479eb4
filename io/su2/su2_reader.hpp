/// SU2 meshes: text (.su2) and binary (.su2b).
///
/// Patches are the markers; NAME_markers.cfg beside NAME.su2, where there is one, gives their conditions,
/// else they are walls; markers of one name are one. Marker SEND_RECEIVE of old files, points and lines are
/// left out. One region, `fluid`. Meshes of two dimensions and files of several zones are errors.
#pragma once

#include "io/raw_mesh.hpp"
namespace aeroloom::io {

/// Rank 0 reads all of it, line by line, and has the only share. Keywords in any order; numbers behind points
/// and elements (their indices) are left out, as are keywords of SU2 that do not concern the mesh.
/// Collective; throws CollectiveError naming file and line: input where it is not such a mesh, has cells of
/// other kinds or points out of range; files where it cannot be read.
RawMesh read_su2(const SharedPath& file);

/// Every rank reads its share at offsets of its own. Either order of bytes, integers of 32 or 64 bits.
/// Collective; throws as read_su2, naming the byte.
RawMesh read_su2b(const SharedPath& file);

}  // namespace aeroloom::io
