/// Reads Gmsh's MSH 4.1, ASCII and binary (little-endian, 64-bit tags), of any origin.
///
/// Regions are physical volumes, patches physical surfaces, of several the first; entities without a group
/// count for themselves (`volume_TAG`, `surface_TAG`). Types of patches come from $Comments as write_msh()
/// leaves them, else from a name that is a type's (`symmetry`), else they are walls. Points, lines, ghost
/// elements and faces between partitions are left out. Other sections are passed over.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// The path is that of a file; or the first of a partitioned mesh, STEM_1.msh, or STEM_*.msh: all files
/// STEM_1.msh ... STEM_N.msh are read, each by one rank. Of one binary file every rank reads a share; an
/// ASCII file is read by rank 0. Throws CollectiveError (input) with the file, the place and what is wrong
/// there, also for higher-order elements, hexahedra and other versions of the format; (files) where it cannot
/// be opened. Collective.
RawMesh read_msh(const SharedPath& file);

}  // namespace aeroloom::io
