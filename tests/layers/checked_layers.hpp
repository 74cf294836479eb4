/// Layers built on small walls, and what has to hold of any.
#pragma once

#include "geometry/predicates.hpp"
#include "layers/cap_layout.hpp"
#include "layers/columns.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/quality/cell_measures.hpp"
#include "tests/meshes/wall_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers::checked {

using geometry::Vec3;
using parallel::Communicator;

/// Layers on patches by their index.
inline LayerOptions options_for(std::vector<double> first) {
  LayerOptions options;
  options.patches.resize(first.size());
  for (std::size_t p = 0; p < first.size(); ++p) options.patches[p].first = first[p];
  return options;
}

inline Layers build(const mesh::DistributedMesh& mesh, const LayerOptions& options,
                    const PlaneRemesher& remesh = {}) {
  const mesh::NumberedMesh wall{mesh::number_mesh(mesh)};
  return build_layers(wall, options, remesh);
}

inline double enclosed_volume(const mesh::DistributedMesh& mesh) {
  double volume6 = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      volume6 += dot(piece.point(v[0]), cross(piece.point(v[1]), piece.point(v[2])));
    }
  }
  return volume6 / 6;
}

/// All ways to cut a prism into tetrahedra: those of four corners that lie in no side, seen from the layers
/// below and above. Written from the definition, not from what the stage does.
inline void expect_good_prism(const std::array<Vec3, 6>& p) {
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      for (int c = b + 1; c < 6; ++c) {
        for (int d = c + 1; d < 6; ++d) {
          const std::array<int, 4> corners{a, b, c, d};
          const auto lower = std::count_if(corners.begin(), corners.end(), [](int i) { return i < 3; });
          const bool is_side = lower == 2 && a == c - 3 && b == d - 3;
          if (is_side) continue;
          // The same corners of a right prism tell the orientation.
          const auto right = [](int i) {
            return Vec3{i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0, i < 3 ? 0.0 : 1.0};
          };
          const int expected = geometry::orient3d(right(a), right(b), right(c), right(d));
          EXPECT_EQ(geometry::orient3d(p[a], p[b], p[c], p[d]), expected);
        }
      }
    }
  }
}

/// Volume of a cell that has to be valid.
template <std::size_t Corners>
double check_cell(mesh::CellShape shape, const std::array<Vec3, Corners>& p) {
  if constexpr (Corners == 6) expect_good_prism(p);
  EXPECT_TRUE(mesh::has_positive_corners(shape, p.data()));
  return mesh::cell_volume(shape, p.data());
}

/// Volume of the cells over a triangle whose columns are counter-clockwise seen from the fluid; expects all
/// to be valid.
inline double check_cells(const mesh::Piece& piece, const PieceColumns& columns,
                          const std::array<std::int32_t, 3>& corners) {
  std::array<std::int32_t, 3> counts;
  for (int i = 0; i < 3; ++i) counts[i] = columns.counts[columns.vertex_of(corners[i])];
  const auto at = [&](int i, std::int32_t k) {
    return node(piece, columns, corners[i], std::min(k, counts[i]));
  };
  double volume = 0;
  for (std::int32_t k = 1; k <= *std::max_element(counts.begin(), counts.end()); ++k) {
    const std::array<Vec3, 6> p{at(0, k - 1), at(1, k - 1), at(2, k - 1), at(0, k), at(1, k), at(2, k)};
    std::array<int, 3> live{};
    int count = 0, dead = 0;
    for (int i = 0; i < 3; ++i) {
      if (counts[i] >= k)
        live[count++] = i;
      else
        dead = i;
    }
    if (count == 3) {
      volume += check_cell(mesh::CellShape::prism, p);
    } else if (count == 2) {
      const int i = (dead + 1) % 3, j = (dead + 2) % 3;
      volume += check_cell(mesh::CellShape::pyramid, std::array{p[i], p[i + 3], p[j + 3], p[j], p[dead]});
    } else {
      volume += check_cell(mesh::CellShape::tetrahedron, std::array{p[0], p[1], p[2], p[live[0] + 3]});
    }
  }
  return volume;
}

/// The same for the cells of a fan, and the pyramid on top of a sector between columns with layers.
inline double check_fan(const mesh::Piece& piece, const PieceColumns& columns, const FanFace& face,
                        const Vec3& apex) {
  const std::array<std::int32_t, 2> ends{columns.vertex_of(face.columns[0]),
                                         columns.vertex_of(face.columns[2])};
  const std::array<std::int32_t, 2> counts{columns.counts[ends[0]], columns.counts[ends[1]]};
  double volume = 0;
  const auto at = [&](int i, std::int32_t k) {
    return node(piece, columns, face.columns[i], std::min(k, counts[i / 2]));
  };
  const std::int32_t most = std::max(counts[0], counts[1]);
  for (std::int32_t k = 1; k <= most; ++k) {
    const auto low = [&](int i) { return at(i, k - 1); };
    const auto high = [&](int i) { return at(i, k); };
    if (!face.is_sector()) {
      if (k == 1)
        volume += check_cell(mesh::CellShape::tetrahedron, std::array{low(0), high(0), high(1), high(2)});
      if (k > 1)
        volume +=
            check_cell(mesh::CellShape::prism, std::array{low(0), low(1), low(2), high(0), high(1), high(2)});
    } else if (counts[0] < k || counts[1] < k) {
      const int a = counts[0] >= k ? 0 : 2, c = 2 - a;
      if (counts[c / 2] > 0)
        volume += check_cell(mesh::CellShape::prism,
                             std::array{low(a), high(c + 1), high(a), low(a + 1), high(c), high(a + 1)});
      else if (k == 1)
        volume += check_cell(mesh::CellShape::tetrahedron, std::array{low(a), high(c), high(a), high(a + 1)});
      else
        volume += check_cell(mesh::CellShape::pyramid,
                             std::array{low(a), high(a), high(a + 1), low(a + 1), high(c)});
    } else if (k == 1) {
      volume +=
          check_cell(mesh::CellShape::prism, std::array{low(0), high(0), high(1), low(2), high(3), high(2)});
    } else {
      volume += check_cell(mesh::CellShape::hexahedron,
                           std::array{low(0), low(1), low(2), low(3), high(0), high(1), high(2), high(3)});
    }
  }
  if (face.is_sector() && counts[0] > 0 && counts[1] > 0)
    volume += check_cell(mesh::CellShape::pyramid,
                         std::array{at(0, most), at(1, most), at(2, most), at(3, most), apex});
  return volume;
}

/// Calls visit(piece, vertex, point) for all vertices.
template <class Visit>
void for_each_vertex(mesh::DistributedMesh& mesh, const Visit& visit) {
  for (mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) visit(piece, v, piece.point(v));
  }
}

/// All cells are valid and fill what lies between wall and cap, which is free of intersections.
inline void expect_valid(const mesh::DistributedMesh& wall, const Layers& layers) {
  const Communicator& communicator = wall.communicator;
  ASSERT_EQ(layers.columns.pieces.size(), wall.pieces.size());
  double volume = 0;
  for (std::size_t p = 0; p < wall.pieces.size(); ++p) {
    const mesh::Piece& piece = wall.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    const CapLayout layout = lay_out_cap(piece, columns);
    const mesh::Piece& cap = layers.cap.pieces[p];
    for (const auto& [a, b, c] : columns.corner_columns) volume += check_cells(piece, columns, {a, c, b});
    for (std::size_t f = 0; f < columns.fan_faces.size(); ++f) {
      const FanFace& face = columns.fan_faces[f];
      const mesh::LocalIndex apex = layout.apex_of_face[f];
      volume += check_fan(piece, columns, face, apex >= 0 ? cap.point(apex) : Vec3{});
    }
    for (std::int32_t c = 0; c < columns.column_count(); ++c) {
      if (layout.vertex_of_column[c] < 0) continue;
      EXPECT_EQ(cap.point(layout.vertex_of_column[c]),
                node(piece, columns, c, columns.counts[columns.vertex_of(c)]));
    }
  }
  const double between = enclosed_volume(wall) - enclosed_volume(layers.cap);
  EXPECT_NEAR(communicator.sum(volume), communicator.sum(between),
              1e-10 * std::abs(communicator.sum(enclosed_volume(wall))));
  EXPECT_TRUE(mesh::find_intersections(layers.cap).empty());
}

}  // namespace aeroloom::layers::checked
