/// The format of UGRID files: kinds by suffix, places of sections, orders of corners, codes of patches.
///
/// Layout after the UG_IO documentation of UGRID files (SimCenter, Mississippi State University: `3D grid
/// file type UGRID`, `3D input/output grids`) and of the High Lift Prediction Workshops (AFLR3, stream
/// access): seven counts, coordinates, triangles, quadrilaterals, their patch ids, tetrahedra, pyramids,
/// prisms, hexahedra; no record marks; numbers from 1.
#pragma once

#include "io/file_mesh.hpp"
#include "io/streams/byte_order.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace aeroloom::io {

/// C binary, double precision: .b8 (big-endian), .lb8 (little-endian), .b8l and .lb8l (64-bit integers; also
/// spelled .b8.ugrid64 and .lb8.ugrid64).
struct UgridKind {
  ByteOrder order = ByteOrder::little;
  int integer_bytes = 4;
  std::string stem;  ///< the path without `.lb8.ugrid` or the like
};
/// By the suffix of a path. Throws std::runtime_error, which lists the suffixes, for any other.
UgridKind ugrid_kind_of(const std::string& path);
/// NAME.mapbc beside NAME.lb8.ugrid.
std::string mapbc_path_of(const std::string& path);

/// The counts at the beginning of a file: points, triangles, quadrilaterals, tetrahedra, pyramids, prisms,
/// hexahedra, of which there are none.
std::array<mesh::GlobalIndex, 7> in_ugrid_order(const ShapeCounts& counts);

/// Offsets of sections in bytes.
struct UgridLayout {
  std::int64_t points = 0;
  std::array<std::int64_t, face_shape_count> faces{}, patch_ids{};
  std::array<std::int64_t, cell_shape_count> cells{};
  std::int64_t end = 0;  ///< of the prisms
};
/// For counts whose sections fit 2^63 bytes.
UgridLayout ugrid_layout(const ShapeCounts& counts, int integer_bytes);
/// Throws std::runtime_error where counts do not fit the integers of the file's kind, naming the suffix that
/// does.
void require_ugrid_fits(const ShapeCounts& counts, const UgridKind& kind, const std::string& path);

/// Corner k of a cell in UGRID's order is corner to_ugrid[shape][k] here. UG_IO has a pyramid's apex third:
/// its base is 1, 4, 5, 2 counter-clockwise seen from the apex 3 (refine's faces of cells, ref_cell.c,
/// agree). Tetrahedra and prisms are as here.
inline constexpr std::array<std::array<std::int8_t, 6>, cell_shape_count> to_ugrid = {
    {{0, 1, 2, 3, -1, -1}, {1, 0, 4, 2, 3, -1}, {0, 1, 2, 3, 4, 5}}};

/// FUN3D's number of a boundary condition (its manual, `boundary conditions`) for a patch: wall 4000, slip
/// 3000, farfield 5000, inlet 7011, outlet 7012; symmetry 6661, 6662, 6663 by the axis that its plane is
/// normal to, 3000 (no flow through it) where that is none of x, y, z.
enum class NormalAxis { x, y, z, none };
int mapbc_code_of(mesh::PatchType type, NormalAxis axis);
/// The type of patch that a number of a mapbc file means: FUN3D's, and USM3D's (its web page `Boundary
/// conditions`: 0 free stream, 1 plane of reflection, 2 extrapolation, 3 characteristic, 4 no slip, 5 tangent
/// flow, 1001 and 1002 inflow and outflow of channels); walls are the answer to numbers that mean nothing
/// here.
mesh::PatchType patch_type_of_mapbc(std::int64_t code);

}  // namespace aeroloom::io
