/// Small pieces for tests of single operations.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
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

/// Turns the cells over that have a negative volume.
inline void orient_cells(mesh::Piece& piece) {
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    LocalIndex* c = piece.cells.data() + 4 * t;
    if (volume6(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3])) < 0)
      std::swap(c[0], c[1]);
  }
}

/// Turns cells over where they must be, and gives the piece the boundary that its cells have, on one CAD
/// face.
inline void close_boundary(mesh::Piece& piece) {
  orient_cells(piece);
  std::map<std::array<LocalIndex, 3>, std::vector<std::array<LocalIndex, 3>>> faces;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
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

/// `count` tetrahedra around an edge along z that passes close by one side of their ring: at this fraction of
/// the way to it.
inline mesh::Piece make_spindle(int count, double beside = 0.99) {
  const double middle = std::numbers::pi / count, off = beside * std::cos(middle);
  std::vector<Vec3> points{{off * std::cos(middle), off * std::sin(middle), -1},
                           {off * std::cos(middle), off * std::sin(middle), 1}};
  std::vector<LocalIndex> cells;
  for (int i = 0; i < count; ++i) {
    points.push_back({std::cos(2 * i * middle), std::sin(2 * i * middle), 0.01 * i});
    cells.insert(cells.end(), {0, 1, 2 + i, 2 + (i + 1) % count});
  }
  return make_piece(points, cells);
}

/// A regular octahedron with an inner vertex.
inline mesh::Piece make_octahedron(Vec3 inner) {
  std::vector<LocalIndex> cells;
  const LocalIndex around[4] = {1, 3, 2, 4};
  for (int i = 0; i < 4; ++i) {
    cells.insert(cells.end(), {0, around[i], around[(i + 1) % 4], 5});
    cells.insert(cells.end(), {0, around[(i + 1) % 4], around[i], 6});
  }
  return make_piece({inner, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, cells);
}

/// An octahedron without an inner vertex: a sliver between an upper and a lower pair of tetrahedra. The
/// sliver comes last.
inline mesh::Piece make_octahedron_with_sliver() {
  mesh::Piece piece =
      make_piece({{1, 0, 0.02}, {-1, 0, 0.02}, {0, 1, -0.02}, {0, -1, -0.02}, {0, 0, 1}, {0, 0, -1}},
                 {0, 2, 1, 4, 1, 3, 0, 4, 2, 0, 3, 5, 3, 1, 2, 5, 0, 1, 2, 3});
  orient_cells(piece);
  return piece;
}

/// A prism whose left side ends in a tetrahedron without thickness, the last one, because the boundary's
/// diagonal there is not that of the tetrahedra inside.
inline mesh::Piece make_prism_with_flat_tet() {
  enum { ridge0, ridge1, left0, left1, right0, right1 };
  mesh::Piece piece =
      make_piece({{0, 0, 0.8}, {0, 1, 0.8 + 1e-9}, {-1, 0, 0}, {-1, 1, 0}, {1, 0, 0}, {1, 1, 0}},
                 {left0, right0, left1, ridge0, right1, ridge0, ridge1, left1, right1, ridge0, left1, right0,
                  ridge0, ridge1, left1, left0});
  orient_cells(piece);
  return piece;
}

/// A pyramid over a square whose base is a flat tetrahedron on top of two others.
inline mesh::Piece make_flat_lid(double height) {
  mesh::Piece piece = make_piece({{1, 0, 0}, {0, 1, height}, {-1, 0, 0}, {0, -1, height}, {0, 0, -1}},
                                 {0, 1, 2, 4, 0, 2, 3, 4, 0, 1, 2, 3});
  close_boundary(piece);
  return piece;
}

}  // namespace aeroloom::improve::examples
