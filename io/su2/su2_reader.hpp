/// Reads SU2 meshes: text (.su2) and binary (.su2b).
///
/// Each marker is a patch; markers of equal name are one patch. NAME_markers.cfg beside NAME.su2 gives the
/// conditions; without it all are walls. The mesh has one region, `fluid`. Marker SEND_RECEIVE of old files,
/// points and lines are left out. Meshes of two dimensions and files of several zones are errors.
#pragma once

#include "io/raw_mesh.hpp"
namespace aeroloom::io {

/// Reads text. Rank 0 reads the whole file, and holds the whole mesh. Keywords come in any order; those that
/// do not concern the mesh are skipped, as are the indices behind points and elements. Collective. Throws
/// CollectiveError with the line: (input) where the file is no such mesh, or has cells of other shapes or
/// points out of range; (files) where it cannot be read.
RawMesh read_su2(const SharedPath& file);

/// Reads binary files of both byte orders, with integers of 32 or 64 bits. Every rank reads its range of the
/// items. Collective; throws as read_su2, with the byte.
RawMesh read_su2b(const SharedPath& file);

}  // namespace aeroloom::io
