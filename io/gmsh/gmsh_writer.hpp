/// Writes Gmsh's MSH 4.1 files: binary, little-endian, 64-bit tags (https://gmsh.info/doc/texinfo/gmsh.html,
/// section "MSH file format").
///
/// Each region is a physical volume with the tag region + 1, each patch a physical surface with the tag patch
/// + 1. Each has one discrete entity of the same tag. Patches between regions are there too. Names are cut to
/// 127 bytes and made different. Line breaks in them become blanks, and double quotes single ones. $Comments
/// has the conditions of patches and the whole names; Gmsh skips it and read_msh() reads it: `patch TAG TYPE
/// NAME`, `region TAG NAME`. The tag of a node is the number of the vertex + 1. Boundary faces are
/// counter-clockwise seen from outside. All nodes are classified on the first volume, so Gmsh must not move
/// nodes: it would move the boundary too.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io {

/// Writes one file, which all ranks write together. Collective; throws CollectiveError (files) with the path.
void write_msh(const FileMesh& mesh, const std::string& path);

/// Writes files STEM_1.msh ... STEM_N.msh for the path STEM.msh, one for each part, with
/// $PartitionedEntities. Each has all groups and entities of the mesh, and the vertices and elements of its
/// part, with the tags of the whole mesh. There are no ghost elements and no entities for faces between
/// parts. Part files of an earlier run are removed. Collective; throws CollectiveError (files) with the path.
void write_msh_parts(const FileMesh& mesh, const std::string& path);
/// Removes STEM_(parts + 1).msh and the files that follow it without a gap, as write_msh_parts() does at its
/// end. Files beyond a gap may belong to the user. Collective; throws CollectiveError.
void remove_later_msh_parts(const SharedPath& file, std::int32_t parts);

}  // namespace aeroloom::io
