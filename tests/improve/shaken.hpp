/// Bad but valid meshes: cubes whose interior vertices are moved at random and whose tetrahedra are flipped
/// at random.
#pragma once

#include "geometry/predicates.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/tet_quality.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::improve::examples {

using mesh::examples::WholeMesh;

inline bool is_positive(const WholeMesh& whole, const std::vector<int>& c) {
  return geometry::orient3d(whole.points[c[0]], whole.points[c[1]], whole.points[c[2]], whole.points[c[3]]) >
         0;
}

/// Moves every interior vertex by up to `amplitude` along each axis, or not at all where that would invert a
/// tetrahedron.
inline void shake(WholeMesh& whole, double amplitude, std::mt19937& random) {
  std::vector<std::vector<int>> cells_of(whole.points.size());
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const int v : whole.cells[c]) cells_of[v].push_back(static_cast<int>(c));
  }
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    if (is_on_boundary(whole.dimensions[v])) continue;
    const geometry::Vec3 origin = whole.points[v];
    for (int axis = 0; axis < 3; ++axis) whole.points[v][axis] += amplitude * (random() / 2147483648.0 - 1);
    const auto holds = [&](int c) { return is_positive(whole, whole.cells[c]); };
    if (!std::all_of(cells_of[v].begin(), cells_of[v].end(), holds)) whole.points[v] = origin;
  }
}

/// One side of a face: its cell, and the cell's vertex opposite to it.
struct FaceSide {
  int cell, apex;
};

inline std::map<std::array<int, 3>, std::vector<FaceSide>> find_face_sides(const WholeMesh& whole) {
  std::map<std::array<int, 3>, std::vector<FaceSide>> sides;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (int f = 0; f < 4; ++f) {
      std::array<int, 3> face;
      for (int i = 0; i < 3; ++i) face[i] = whole.cells[c][mesh::tetrahedron_faces[f][i]];
      std::sort(face.begin(), face.end());
      sides[face].push_back({static_cast<int>(c), whole.cells[c][f]});
    }
  }
  return sides;
}

/// Replaces the two tetrahedra at a random interior face of one piece by three, where those are valid;
/// `flips` times.
inline void flip_at_random(WholeMesh& whole, int flips, std::mt19937& random) {
  auto sides = find_face_sides(whole);
  for (int tries = 0; flips > 0 && tries < 1000; ++tries) {
    const auto& [face, around] = *std::next(sides.begin(), random() % sides.size());
    if (around.size() != 2 || whole.piece_of_cell[around[0].cell] != whole.piece_of_cell[around[1].cell])
      continue;
    std::vector<std::vector<int>> fresh;
    for (int i = 0; i < 3; ++i) {
      std::vector<int> cell{around[0].apex, around[1].apex, face[i], face[(i + 1) % 3]};
      if (!is_positive(whole, {face[0], face[1], face[2], around[1].apex})) std::swap(cell[2], cell[3]);
      fresh.push_back(cell);
    }
    if (!std::all_of(fresh.begin(), fresh.end(), [&](const auto& c) { return is_positive(whole, c); }))
      continue;
    whole.cells[around[0].cell] = fresh[0];
    whole.cells[around[1].cell] = fresh[1];
    whole.cells.push_back(fresh[2]);
    whole.piece_of_cell.push_back(whole.piece_of_cell[around[0].cell]);
    sides = find_face_sides(whole);
    --flips;
  }
}

inline WholeMesh shaken_cube(int n, int pieces, int flips, std::uint32_t seed) {
  std::mt19937 random(seed);
  WholeMesh whole = mesh::examples::whole_cube(n, pieces);
  shake(whole, 0.6 / n, random);
  flip_at_random(whole, flips, random);
  return whole;
}

struct Extremes {
  double quality = std::numeric_limits<double>::max();
  double angle = 180;
  std::int64_t bad = 0;
};

/// The worst of all pieces; angles and bad ones by the angles alone.
inline Extremes examine(const std::vector<mesh::Piece>& pieces, double target_angle) {
  const mesh::TetQuality measure(target_angle);
  Extremes extremes;
  for (const mesh::Piece& piece : pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* c = piece.cell(t);
      const geometry::Vec3 p[4] = {piece.point(c[0]), piece.point(c[1]), piece.point(c[2]),
                                   piece.point(c[3])};
      const mesh::DihedralRange range = mesh::dihedral_range(p[0], p[1], p[2], p[3]);
      extremes.quality = std::min(extremes.quality, measure(p[0], p[1], p[2], p[3]));
      extremes.angle = std::min(extremes.angle, range.smallest);
      extremes.bad += range.smallest < target_angle || range.largest > 180 - 1.5 * target_angle;
    }
  }
  return extremes;
}

/// A valid mesh that fills the unit cube.
inline void expect_valid(const mesh::DistributedMesh& mesh) {
  const auto report = mesh::check_volume_mesh(mesh::number_mesh(mesh), nullptr);
  EXPECT_TRUE(report.valid()) << report.violations.front();
  EXPECT_NEAR(report.volume, 1, 1e-12);
}

}  // namespace aeroloom::improve::examples
