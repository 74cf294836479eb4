/// Names and conditions of patches in SU2, which calls patches markers.
#pragma once

#include "io/boundary_patches.hpp"
#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The longest name in a binary file, which has 33 bytes for it with the final zero. Text files get the same
/// names, so that one SU2 configuration serves both.
inline constexpr std::size_t most_marker_bytes = 32;

/// The names of the patches in a file, all different and none SEND_RECEIVE (see plain_names). Letters,
/// digits, `_ - + .` and non-ASCII characters stay; others become `_`. Names are cut to 32 bytes.
std::vector<std::string> marker_names(const FileMesh& mesh, const BoundaryPatches& patches);

/// NAME_markers.cfg beside NAME.su2 or NAME.su2b.
std::string markers_path_of(const std::string& path);

/// Removes NAME_markers.cfg, so that no conditions of an earlier mesh stay beside a new mesh. Collective;
/// throws CollectiveError (files).
void remove_markers(const SharedPath& mesh_file);
/// Writes lines for an SU2 configuration to NAME_markers.cfg: the markers of the mesh file `mesh_path` by
/// condition. Walls are MARKER_HEATFLUX (adiabatic), slip MARKER_EULER, symmetry MARKER_SYM, farfield
/// MARKER_FAR. Inlets and outlets are comments, because the user must fill in values. Collective; throws
/// CollectiveError (files).
void write_markers(const std::string& mesh_path, const FileMesh& mesh, const BoundaryPatches& patches,
                   const std::vector<std::string>& names);

/// Gives patches the conditions of NAME_markers.cfg, if that file exists. Comments that begin with `%
/// MARKER_` count too. Patches without a condition get the type of their name (mesh::patch_type_by_name), or
/// stay. The file is ignored, with a warning, if it has a marker that the mesh does not have. Collective;
/// throws CollectiveError (input, files).
void set_marker_types(const SharedPath& mesh_file, std::vector<mesh::Patch>& patches);

}  // namespace aeroloom::io
