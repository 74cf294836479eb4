/// Names and conditions of patches as SU2 has them.
#pragma once

#include "io/boundary_patches.hpp"
#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Of a name in a binary file, which has 33 bytes for it and a zero. Text files get the same names, so that
/// one configuration serves both.
inline constexpr std::size_t most_marker_bytes = 32;

/// The name of each patch in a file: letters, digits, `_ - + .` and what is beyond ASCII stay, all else
/// becomes `_`; cut to 32 bytes, different from each other, none SEND_RECEIVE (plain_names).
std::vector<std::string> marker_names(const FileMesh& mesh, const BoundaryPatches& patches);

/// NAME_markers.cfg beside NAME.su2 or NAME.su2b.
std::string markers_path_of(const std::string& path);

/// Removes NAME_markers.cfg: conditions of an earlier mesh must not stand beside a new one. Collective;
/// throws CollectiveError (files).
void remove_markers(const SharedPath& mesh_file);
/// Writes lines for an SU2 configuration to NAME_markers.cfg: the markers of the mesh at `mesh_path` by
/// condition. Walls are MARKER_HEATFLUX (adiabatic), slip MARKER_EULER, symmetry MARKER_SYM, farfield
/// MARKER_FAR; inlets and outlets stand in comments, as values of their own must be filled in. Collective;
/// throws CollectiveError (files).
void write_markers(const std::string& mesh_path, const FileMesh& mesh, const BoundaryPatches& patches,
                   const std::vector<std::string>& names);

/// Gives patches the conditions that NAME_markers.cfg has for their names, where there is one; comments that
/// begin with `% MARKER_` count. Others are what their name says (mesh::patch_type_by_name), or stay. A file
/// with a marker that the mesh does not have is left alone, with a warning. Collective; throws
/// CollectiveError (input, files).
void set_marker_types(const SharedPath& mesh_file, std::vector<mesh::Patch>& patches);

}  // namespace aeroloom::io
