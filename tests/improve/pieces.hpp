/// Small pieces for tests of single operations.
#pragma once

#include "improve/tet_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::improve::examples {

/// A piece of one region without classification on a boundary.
inline mesh::Piece make_piece(const std::vector<Vec3>& points, std::vector<LocalIndex> cells) {
  mesh::Piece piece;
  for (const Vec3 p : points) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  piece.vertex_dimension.assign(points.size(), mesh::CadDimension::region);
  piece.vertex_entity.assign(points.size(), 0);
  piece.cells = std::move(cells);
  return piece;
}

/// The volume of a piece, whose cells are all expected to be positive.
inline double volume(const mesh::Piece& piece) {
  double sum = 0;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    const double six = volume6(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]));
    EXPECT_GT(six, 0);
    sum += six / 6;
  }
  return sum;
}

/// Turns cells over where they must be, and gives the piece the boundary that its cells have, on one CAD
/// face.
inline void close_boundary(mesh::Piece& piece) {
  std::map<std::array<LocalIndex, 3>, std::vector<std::array<LocalIndex, 3>>> faces;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    LocalIndex* c = piece.cells.data() + 4 * t;
    if (volume6(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3])) < 0)
      std::swap(c[0], c[1]);
    for (const auto& f : mesh::tetrahedron_faces) {
      std::array<LocalIndex, 3> key{c[f[0]], c[f[1]], c[f[2]]};
      const auto corners = key;
      std::sort(key.begin(), key.end());
      faces[key].push_back(corners);
    }
  }
  for (const auto& [key, sides] : faces) {
    if (sides.size() > 1) continue;
    piece.boundary.insert(piece.boundary.end(), sides[0].begin(), sides[0].end());
    piece.triangle_face.push_back(0);
    piece.triangle_patch.push_back(0);
    for (const LocalIndex v : key) piece.vertex_dimension[v] = mesh::CadDimension::face;
  }
}

}  // namespace aeroloom::improve::examples
