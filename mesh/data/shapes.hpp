/// Shapes of cells and of their faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace aeroloom::mesh {

/// Corners in the order that CGNS, Gmsh and Medit share; all have positive volume. Tetrahedron: VTK's order.
/// Pyramid: base 0, 1, 2, 3 counter-clockwise seen from its apex 4. Prism: triangle 0, 1, 2 counter-clockwise
/// seen from the triangle 3, 4, 5 opposite, 3 opposite 0 (VTK has it the other way round). Hexahedron: 0, 1,
/// 2, 3 counter-clockwise seen from 4, 5, 6, 7 opposite, 4 opposite 0.
enum class CellShape : std::uint8_t { tetrahedron, pyramid, prism, hexahedron };
inline constexpr int cell_shape_count = 4;
inline constexpr std::array<CellShape, cell_shape_count> cell_shapes = {
    CellShape::tetrahedron, CellShape::pyramid, CellShape::prism, CellShape::hexahedron};
inline constexpr int corners_of(CellShape shape) {
  return shape == CellShape::hexahedron ? 8 : static_cast<int>(shape) + 4;
}
inline constexpr std::size_t most_corners = corners_of(CellShape::hexahedron);

/// Of boundary faces: counter-clockwise seen from outside the fluid (from the front region, of faces between
/// two), what a normal out of the fluid sees.
enum class FaceShape : std::uint8_t { triangle, quadrilateral };
inline constexpr int face_shape_count = 2;
inline constexpr std::array<FaceShape, face_shape_count> face_shapes = {FaceShape::triangle,
                                                                        FaceShape::quadrilateral};
inline constexpr int corners_of(FaceShape shape) {
  return static_cast<int>(shape) + 3;
}

/// A face of a cell by its corners, counter-clockwise seen from outside the cell; a triangle's fourth is -1.
using CellFace = std::array<std::int8_t, 4>;
inline constexpr std::array<CellFace, 4> faces_of_tetrahedra = {
    {{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
inline constexpr std::array<CellFace, 5> faces_of_pyramids = {
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
inline constexpr std::array<CellFace, 5> faces_of_prisms = {
    {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
inline constexpr std::array<CellFace, 6> faces_of_hexahedra = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// The faces of a cell: 4, 5, 5 and 6.
inline constexpr std::span<const CellFace> faces_of(CellShape shape) {
  if (shape == CellShape::tetrahedron) return faces_of_tetrahedra;
  if (shape == CellShape::pyramid) return faces_of_pyramids;
  if (shape == CellShape::prism) return faces_of_prisms;
  return faces_of_hexahedra;
}

}  // namespace aeroloom::mesh
