/// Layers built on small walls, and what has to hold of any.
#pragma once

#include "geometry/predicates.hpp"
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

/// Volume of the cells over a triangle whose corners are counter-clockwise seen from the fluid; expects all
/// to be valid.
inline double check_cells(const mesh::Piece& piece, const PieceColumns& columns,
                          std::array<mesh::LocalIndex, 3> v) {
  const auto at = [&](int i, std::int32_t k) {
    return node(piece, columns, v[i], std::min(k, columns.counts[v[i]]));
  };
  const std::int32_t most = std::max({columns.counts[v[0]], columns.counts[v[1]], columns.counts[v[2]]});
  double volume = 0;
  for (std::int32_t k = 1; k <= most; ++k) {
    const std::array<Vec3, 6> p{at(0, k - 1), at(1, k - 1), at(2, k - 1), at(0, k), at(1, k), at(2, k)};
    std::array<int, 3> live{};
    int count = 0, dead = 0;
    for (int i = 0; i < 3; ++i) {
      if (columns.counts[v[i]] >= k)
        live[count++] = i;
      else
        dead = i;
    }
    if (count == 3) {
      expect_good_prism(p);
      volume += mesh::cell_volume(mesh::CellShape::prism, p.data());
    } else if (count == 2) {
      const int i = (dead + 1) % 3, j = (dead + 2) % 3;
      const std::array<Vec3, 5> pyramid{p[i], p[i + 3], p[j + 3], p[j], p[dead]};
      EXPECT_TRUE(mesh::has_positive_corners(mesh::CellShape::pyramid, pyramid.data()));
      volume += mesh::cell_volume(mesh::CellShape::pyramid, pyramid.data());
    } else {
      const std::array<Vec3, 4> tetrahedron{p[0], p[1], p[2], p[live[0] + 3]};
      EXPECT_TRUE(mesh::has_positive_corners(mesh::CellShape::tetrahedron, tetrahedron.data()));
      volume += mesh::cell_volume(mesh::CellShape::tetrahedron, tetrahedron.data());
    }
  }
  return volume;
}

/// All cells are valid and fill what lies between wall and cap, which is free of intersections.
inline void expect_valid(const mesh::DistributedMesh& wall, const Layers& layers) {
  const Communicator& communicator = wall.communicator;
  ASSERT_EQ(layers.columns.pieces.size(), wall.pieces.size());
  double volume = 0;
  for (std::size_t p = 0; p < wall.pieces.size(); ++p) {
    const mesh::Piece& piece = wall.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      volume += check_cells(piece, columns, {v[0], v[2], v[1]});
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
      EXPECT_EQ(layers.cap.pieces[p].point(v), node(piece, columns, v, columns.counts[v]));
  }
  const double between = enclosed_volume(wall) - enclosed_volume(layers.cap);
  EXPECT_NEAR(communicator.sum(volume), communicator.sum(between),
              1e-10 * std::abs(communicator.sum(enclosed_volume(wall))));
  EXPECT_TRUE(mesh::find_intersections(layers.cap).empty());
}

}  // namespace aeroloom::layers::checked
