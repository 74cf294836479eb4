/// Small pieces for tests of single operations.
#pragma once

#include "improve/tet_mesh.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::improve::examples {

/// A piece of one region without classification on a boundary.
inline mesh::Piece make_piece(const std::vector<Vec3>& points, std::vector<LocalIndex> cells) {
  mesh::Piece piece;
  for (const Vec3 p : points) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  piece.vertex_dimension.assign(points.size(), 3);
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

}  // namespace aeroloom::improve::examples
