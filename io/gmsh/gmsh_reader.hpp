/// Reads Gmsh's MSH 4.1 files of any origin: ASCII, and binary with little-endian 64-bit tags.
///
/// Regions are the physical volumes, patches the physical surfaces. Of several groups of an entity the first
/// one counts. An entity without a group is a region `volume_TAG` or a patch `surface_TAG`. The condition of
/// a patch comes from $Comments (see write_msh), or else from its name (`symmetry`); all others are walls.
/// Points, lines, ghost elements and faces between partitions are left out. Other sections are skipped.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// The path is that of a file. For a partitioned mesh it is the first file STEM_1.msh, or the pattern
/// STEM_*.msh. Then all files STEM_1.msh ... STEM_N.msh are read, each by one rank. Of a single binary file
/// every rank reads a range; rank 0 reads an ASCII file. Collective. Throws CollectiveError with the file and
/// the place: (input) for damage, elements of higher order and other versions of the format;
/// (files) where a file cannot be opened.
RawMesh read_msh(const SharedPath& file);

}  // namespace aeroloom::io
