/// Places in binary SU2 files.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::io {

/// Bytes of the name of a marker, its zero included.
inline constexpr std::int64_t su2b_name_bytes = 33;

/// Integers that an element has in the connectivity: VTK's type, corners, and of cells their number.
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

/// Offsets in bytes. A section of elements is their count, the place of each in the connectivity and the
/// connectivity's length, then the connectivity.
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
/// 32-bit integers where all numbers fit.
Su2bLayout su2b_layout(const Su2bCounts& counts);

/// The first element of a shape among all of a section, and its place in the connectivity.
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
