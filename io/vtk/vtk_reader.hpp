/// Reads VTK files of any origin.
#pragma once

#include "io/raw_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Reads the tetrahedra, pyramids, prisms and hexahedra of a .vtu, .pvtu or (legacy) .vtk file in any
/// encoding. The files of a .pvtu are distributed over ranks; one rank reads a single file. VTK reads in a
/// child process, so that no file can crash the program (in a host program only with worker servers,
/// parallel/sandbox/sandbox.hpp).
///
/// Points with equal `global_id` are one point (or with equal ids in the array that the file marks as
/// GlobalIds). Without ids, points of a .pvtu are one where all three coordinates have the same bits; points
/// of a single file stay apart. Regions come from the first cell array of whole numbers among `region` (names
/// in the field array `region_names`), `gmsh:physical`, `CellEntityIds`, `gmsh:geometrical` and `medit:ref`.
/// They are called volume_VALUE, or `volume` without such an array. Boundary faces come from the field arrays
/// of write_volume(), or else from triangles and quadrilaterals. Their patches come from the array `patch`
/// (names in `patch_names`, types in `patch_types`) or from the arrays above. They are called patch_VALUE, or
/// `boundary`. Points, lines and ghost cells (`vtkGhostType`) are left out. The result does not depend on the
/// number of ranks. Collective. Throws CollectiveError: (files) where a file cannot be opened; (input) for
/// damage, and for cells of other shapes or of higher order.
RawMesh read_vtk(const SharedPath& file);

/// The number of files in a .pvtu index; 0 for other files. Not collective.
int parts_named_in_pvtu(const std::string& path);

}  // namespace aeroloom::io
