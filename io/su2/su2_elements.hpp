/// Elements of SU2 meshes, whose types are VTK's.
#pragma once

#include "io/raw_mesh.hpp"
#include "io/vtk_order.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::io {

/// The shape of an element: a cell, a face, or neither (points and lines, which readers leave out).
struct Su2Element {
  std::optional<CellShape> cell;
  std::optional<FaceShape> face;
  int corners = 0;

  static constexpr std::int64_t point = 1, line = 3;
};

/// The element of a type; empty for types that are not supported.
inline std::optional<Su2Element> su2_element_of(std::int64_t type) {
  for (const CellShape shape : cell_shapes) {
    if (vtk_cell_type[static_cast<std::size_t>(shape)] == type)
      return Su2Element{shape, std::nullopt, corners_of(shape)};
  }
  for (const FaceShape shape : face_shapes) {
    if (vtk_face_type[static_cast<std::size_t>(shape)] == type)
      return Su2Element{std::nullopt, shape, corners_of(shape)};
  }
  if (type == Su2Element::point) return Su2Element{std::nullopt, std::nullopt, 1};
  if (type == Su2Element::line) return Su2Element{std::nullopt, std::nullopt, 2};
  return std::nullopt;
}

/// Appends an element with points in VTK's order. `patch`: of a marker, or -1 for an element of the volume.
/// Points and lines, and faces of the volume, are left out.
template <class Points>
void append_su2_element(RawMesh& raw, const Su2Element& element, const Points& points, std::int32_t patch) {
  const auto count = static_cast<std::size_t>(element.corners);
  if (element.cell) {
    const auto s = static_cast<std::size_t>(*element.cell);
    for (std::size_t k = 0; k < count; ++k)
      raw.cells[s].push_back(static_cast<mesh::GlobalIndex>(points[static_cast<std::size_t>(to_vtk[s][k])]));
    raw.cell_regions[s].push_back(0);
  } else if (element.face && patch >= 0) {
    const auto s = static_cast<std::size_t>(*element.face);
    for (std::size_t k = 0; k < count; ++k) raw.faces[s].push_back(static_cast<mesh::GlobalIndex>(points[k]));
    raw.face_patches[s].push_back(patch);
  }
}

/// The text of a message about a type that is not supported.
inline std::string su2_type_text(std::int64_t type) {
  return "elements of type " + std::to_string(type) + " are not supported";
}

}  // namespace aeroloom::io
