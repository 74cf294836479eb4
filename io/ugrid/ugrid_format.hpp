/// The format of UGRID files: suffixes, places of sections, order of corners, codes of conditions.
///
/// The layout follows the UG_IO documentation (SimCenter, Mississippi State University: `3D grid file type
/// UGRID`, `3D input/output grids`) and the High Lift Prediction Workshops (AFLR3, stream access). A file has
/// seven counts, coordinates, triangles, quadrilaterals, their patch ids, tetrahedra, pyramids, prisms and
/// hexahedra. There are no record marks, and numbers begin at 1. Optional integers follow: the number of
/// tetrahedra in boundary layers, an id of each cell, two flags of each face.
#pragma once

#include "io/file_mesh.hpp"
#include "io/streams/byte_order.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace aeroloom::io {

/// C binary in double precision: .b8 is big-endian, .lb8 little-endian; .b8l and .lb8l have 64-bit integers
/// (also called .b8.ugrid64 and .lb8.ugrid64).
struct UgridKind {
  ByteOrder order = ByteOrder::little;
  int integer_bytes = 4;
  std::string stem;  ///< the path without a suffix like `.lb8.ugrid`
};
/// The kind by the suffix of a path. Throws std::runtime_error with the list of suffixes for others.
UgridKind ugrid_kind_of(const std::string& path);
/// The path NAME.mapbc for NAME.lb8.ugrid.
std::string mapbc_path_of(const std::string& path);

/// The counts at the beginning of a file: points, triangles, quadrilaterals, tetrahedra, pyramids, prisms and
/// hexahedra.
std::array<mesh::GlobalIndex, 7> in_ugrid_order(const ShapeCounts& counts);

/// The offsets of the sections in bytes.
struct UgridLayout {
  std::int64_t points = 0;
  std::array<std::int64_t, face_shape_count> faces{}, patch_ids{};
  std::array<std::int64_t, cell_shape_count> cells{};
  std::int64_t end = 0;  ///< of the cells
};
/// All sections together must be smaller than 2^63 bytes.
UgridLayout ugrid_layout(const ShapeCounts& counts, int integer_bytes);
/// Throws std::runtime_error where counts do not fit the integers of this kind of file. The message has the
/// suffix that does.
void require_ugrid_fits(const ShapeCounts& counts, const UgridKind& kind, const std::string& path);

/// Corner k of a cell in UGRID's order is corner to_ugrid[shape][k] of CellShape. UG_IO has the apex of a
/// pyramid third: the base is 1, 4, 5, 2, counter-clockwise seen from the apex 3. The faces of cells in
/// refine (ref_cell.c) agree. The other shapes have the same order in both.
inline constexpr std::array<std::array<std::int8_t, mesh::most_corners>, cell_shape_count> to_ugrid = {
    {{0, 1, 2, 3, -1, -1, -1, -1},
     {1, 0, 4, 2, 3, -1, -1, -1},
     {0, 1, 2, 3, 4, 5, -1, -1},
     {0, 1, 2, 3, 4, 5, 6, 7}}};

/// FUN3D's number of a boundary condition (its manual, `boundary conditions`): wall 4000, slip 3000, farfield
/// 5000, inlet 7011, outlet 7012. A symmetry plane normal to x, y, z has 6661, 6662, 6663. Any other has
/// 3000, which is a wall with slip.
enum class NormalAxis { x, y, z, none };
int mapbc_code_of(mesh::PatchType type, NormalAxis axis);
/// The type of patch for a number in a .mapbc file, of FUN3D or USM3D (web page `Boundary conditions`: 0 free
/// stream, 1 reflection plane, 2 extrapolation, 3 characteristic, 4 no slip, 5 tangent flow, 1001 and 1002
/// inflow and outflow of channels). Unknown numbers are walls.
mesh::PatchType patch_type_of_mapbc(std::int64_t code);

}  // namespace aeroloom::io
