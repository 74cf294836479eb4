/// The places of the sections in binary SU2 files.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::io {

/// The bytes of the name of a marker, with the final zero.
inline constexpr std::int64_t su2b_name_bytes = 33;

/// The integers of an element in the connectivity: VTK's type, the corners, and the number of a cell.
inline constexpr std::int64_t su2b_integers(CellShape shape) {
  return corners_of(shape) + 2;
}
inline constexpr std::int64_t su2b_integers(FaceShape shape) {
  return corners_of(shape) + 1;
}

struct Su2bCounts {
  mesh::GlobalIndex points = 0;
  std::array<mesh::GlobalIndex, cell_shape_count> cells{};
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> markers;
};

/// Offsets in bytes. A section of elements has their count, the place of each in the connectivity, the length
/// of the connectivity, and the connectivity.
struct Su2bLayout {
  struct Section {
    std::int64_t count = 0, places = 0, connectivity = 0;
  };
  std::int64_t integer_bytes = 8;
  Section cells;
  std::int64_t point_count = 0, points = 0, marker_count = 0;
  std::vector<std::int64_t> names;
  std::vector<Section> markers;
  std::int64_t end = 0;

  std::int64_t point_bytes() const { return 24 + integer_bytes; }
};
/// The layout with 32-bit integers if all numbers fit, otherwise with 64-bit integers.
Su2bLayout su2b_layout(const Su2bCounts& counts);

/// The number of the first element of a shape in a section, and its place in the connectivity.
struct Su2bStart {
  std::int64_t element = 0, integer = 0;
};
template <std::size_t N>
Su2bStart su2b_start(const std::array<mesh::GlobalIndex, N>& counts, std::size_t shape) {
  Su2bStart start;
  for (std::size_t s = 0; s < shape; ++s) {
    start.element += counts[s];
    if constexpr (N == cell_shape_count) {
      start.integer += counts[s] * su2b_integers(cell_shapes[s]);
    } else {
      start.integer += counts[s] * su2b_integers(face_shapes[s]);
    }
  }
  return start;
}

}  // namespace aeroloom::io
