/// Writes Gmsh's MSH 4.1, binary, little-endian, 64-bit tags (https://gmsh.info/doc/texinfo/gmsh.html,
/// section "MSH file format").
///
/// Regions and patches, interior ones too, are physical groups (volumes: region + 1, surfaces: patch + 1)
/// with their names, each on a discrete entity of the same tag. Names are cut to 127 bytes and kept distinct;
/// line breaks become blanks, double quotes single ones. Types of patches and uncut names stand in $Comments,
/// which Gmsh passes over and read_msh() reads: `patch TAG TYPE NAME`, `region TAG NAME`. Tags of nodes are
/// numbers of vertices + 1. Boundary faces are counter-clockwise seen from outside. All nodes are classified
/// on the first volume: relocating them by Gmsh would move the boundary too.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io {

/// One file, whatever the parts; ranks write at once. Collective; throws CollectiveError (files) with the
/// path.
void write_msh(const FileMesh& mesh, const std::string& path);

/// Files STEM_1.msh ... STEM_N.msh for `path` STEM.msh, one for each part, with $PartitionedEntities; those
/// of an earlier run go. Each has all groups and entities of the mesh, the vertices of its part and its
/// elements, with tags of the whole mesh; no ghosts, and no entities for faces between parts. Collective;
/// throws CollectiveError (files) with the path.
void write_msh_parts(const FileMesh& mesh, const std::string& path);
/// Removes STEM_(parts + 1).msh and those that follow it without a gap; other files of such names are not
/// ours. write_msh_parts() does it where it writes. Collective; throws CollectiveError.
void remove_later_msh_parts(const SharedPath& file, std::int32_t parts);

}  // namespace aeroloom::io
