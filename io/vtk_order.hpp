/// VTK's numbers of shapes, and its order of corners.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::io {

/// VTK's number of each shape.
inline constexpr std::array<std::uint8_t, cell_shape_count> vtk_cell_type = {10, 14, 13, 12};
inline constexpr std::array<std::uint8_t, face_shape_count> vtk_face_type = {5, 9};

/// Corner k of a cell in VTK's order is corner to_vtk[shape][k] of CellShape, and the reverse. In VTK
/// triangle 0, 1, 2 of a prism points outward.
inline constexpr std::array<std::array<std::int8_t, mesh::most_corners>, cell_shape_count> to_vtk = {
    {{0, 1, 2, 3, -1, -1, -1, -1},
     {0, 1, 2, 3, 4, -1, -1, -1},
     {0, 2, 1, 3, 5, 4, -1, -1},
     {0, 1, 2, 3, 4, 5, 6, 7}}};

}  // namespace aeroloom::io
