/// Meshes from VTK files of any origin.
#pragma once

#include "io/raw_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Reads the tetrahedra, pyramids and prisms of a .vtu, .pvtu or (legacy) .vtk file, in any of their forms.
/// The parts of a .pvtu are spread over ranks, each read by one; a single file is read by one rank. VTK reads
/// in a child process, so that no file can take the program down; of the libraries that run without worker
/// servers (parallel/sandbox/sandbox.hpp), this does not hold.
///
/// Points with equal `global_id` are one (or with equal ids in the array that the file declares its
/// GlobalIds). Without ids, points of a .pvtu are one where all three coordinates have equal bits, and those
/// of a single file as they stand. Regions come from the first cell array of whole numbers among `region`
/// (names from the field array `region_names`), `gmsh:physical`, `CellEntityIds`, `gmsh:geometrical` and
/// `medit:ref`; they are called volume_VALUE, or `volume` without one. Boundary faces come from field arrays
/// where they are as write_volume makes them; else they are the triangles and quadrilaterals, with patches by
/// `patch` (names from `patch_names` and `patch_types`) or the same arrays as regions, called patch_VALUE, or
/// `boundary` without one. Points, lines and ghost cells (`vtkGhostType`) are left out. Throws
/// CollectiveError: files where one cannot be opened; input where it is damaged, or has cells of other kinds
/// or of higher order. Collective; the same for any number of ranks.
RawMesh read_vtk(const SharedPath& file);

/// The parts that a .pvtu names; 0 of other files. By one rank.
int parts_named_in_pvtu(const std::string& path);

}  // namespace aeroloom::io
