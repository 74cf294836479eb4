/// Elements of SU2 meshes by VTK's type.
#pragma once

#include "io/file_mesh.hpp"
#include "io/vtk_order.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::io {

/// Exactly one is set, or neither for points and lines, which are left out.
struct Su2Element {
  std::optional<CellShape> cell;
  std::optional<FaceShape> face;
  int corners = 0;

  static constexpr std::int64_t point = 1, line = 3;
};

/// The element of a type; none where it is not supported.
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

/// For messages.
inline std::string su2_type_text(std::int64_t type) {
  if (type == 12) return "hexahedra (type 12) are not supported";
  return "elements of type " + std::to_string(type) + " are not supported";
}

}  // namespace aeroloom::io
