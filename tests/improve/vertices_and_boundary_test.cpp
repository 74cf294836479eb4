#include "improve/operations/boundary_flip.hpp"
#include "improve/operations/edge_contraction.hpp"
#include "improve/operations/mean_ratio_smoothing.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "mesh/quality/quality.hpp"
#include "tests/improve/pieces.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::close_boundary;
using examples::make_flat_lid;
using examples::make_piece;
using examples::volume;

const mesh::TetQuality measure(15);

TEST(BoundaryFlip, TakesAFlatTetrahedronAway) {
  mesh::Piece piece = make_flat_lid(0.02);
  const double before = volume(piece);
  TetMesh mesh(piece, measure);
  BoundaryFlip flip;
  CavityReplacement cavity;
  bool proposed = false;
  for (int edge = 0; edge < 6 && !proposed; ++edge) proposed = flip.propose(mesh, 2, edge, -1, cavity);
  ASSERT_TRUE(proposed);
  EXPECT_EQ(cavity.old_tets.size(), 1u);
  EXPECT_TRUE(cavity.new_tets.empty());
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  EXPECT_EQ(mesh.changed_triangles(), 2);
  mesh.finish();
  EXPECT_EQ(piece.cell_count(), 2);
  EXPECT_EQ(piece.boundary_count(), 6);
  EXPECT_NEAR(volume(piece), before, 0.05 * before);
  mesh::Piece closed = piece;
  closed.boundary.clear(), closed.triangle_face.clear(), closed.triangle_patch.clear();
  close_boundary(closed);
  const auto sorted_triangles = [](const mesh::Piece& p) {
    std::multiset<std::array<LocalIndex, 3>> triangles;
    for (LocalIndex t = 0; t < p.boundary_count(); ++t) {
      std::array<LocalIndex, 3> v;
      std::copy_n(p.boundary_triangle(t), 3, v.begin());
      std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
      triangles.insert(v);
    }
    return triangles;
  };
  EXPECT_EQ(sorted_triangles(piece), sorted_triangles(closed));
}

TEST(BoundaryFlip, KeepsEdgesBetweenFacesAndSharpOnes) {
  const auto proposes = [](mesh::Piece piece) {
    TetMesh mesh(piece, measure);
    BoundaryFlip flip;
    CavityReplacement cavity;
    bool any = false;
    for (int edge = 0; edge < 6; ++edge) any = flip.propose(mesh, 2, edge, -1, cavity) || any;
    return any;
  };
  EXPECT_TRUE(proposes(make_flat_lid(0.02)));
  EXPECT_FALSE(proposes(make_flat_lid(0.4))) << "triangles turn by more than they may";
  mesh::Piece two_faces = make_flat_lid(0.02);
  for (LocalIndex t = 0; t < two_faces.boundary_count(); ++t) two_faces.triangle_face[t] = t;
  EXPECT_FALSE(proposes(two_faces));
  mesh::Piece other_piece = make_flat_lid(0.02);
  for (LocalIndex v = 0; v < 4; ++v) {
    other_piece.shared_vertices.push_back(v);
    other_piece.shared_keys.push_back(v);
  }
  EXPECT_FALSE(proposes(other_piece)) << "another piece may know the triangles";
}

/// The body-centred lattice of n^3 cells as its Delaunay tetrahedra: four around each face between two cells'
/// centres.
mesh::Piece make_lattice(int n) {
  std::vector<Vec3> points;
  const auto corner = [n](int i, int j, int k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) points.push_back({double(i), double(j), double(k)});
  const int corners = static_cast<int>(points.size());
  const auto centre = [n, corners](int i, int j, int k) { return corners + (i * n + j) * n + k; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) points.push_back({i + 0.5, j + 0.5, k + 0.5});
  std::vector<LocalIndex> cells;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          std::array<int, 3> low{i, j, k}, high = low;
          if (++high[axis] == n) continue;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 3> at = high;
          std::array<LocalIndex, 4> ring;
          for (int turn = 0; turn < 4; ++turn) {
            at[u] = high[u] + (turn == 1 || turn == 2);
            at[v] = high[v] + (turn >= 2);
            ring[turn] = corner(at[0], at[1], at[2]);
          }
          for (int turn = 0; turn < 4; ++turn) {
            cells.insert(cells.end(), {centre(low[0], low[1], low[2]), centre(high[0], high[1], high[2]),
                                       ring[turn], ring[(turn + 1) % 4]});
          }
        }
  }
  // Corners of the block have no tetrahedron.
  std::vector<LocalIndex> number(points.size(), -1);
  std::vector<Vec3> used;
  for (LocalIndex& v : cells) {
    if (number[v] < 0) {
      number[v] = static_cast<LocalIndex>(used.size());
      used.push_back(points[v]);
    }
    v = number[v];
  }
  mesh::Piece piece = make_piece(used, cells);
  close_boundary(piece);
  return piece;
}

LocalIndex vertex_at(const mesh::Piece& piece, Vec3 p) {
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (distance(piece.point(v), p) < 1e-9) return v;
  }
  return -1;
}

TEST(MeanRatioSmoothing, LiftsTheAverageAndNeverTheWorst) {
  mesh::Piece piece = make_lattice(5);
  std::mt19937 random(7);
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (is_on_boundary(piece.vertex_dimension[v])) continue;
    Vec3 p = piece.point(v);
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.2 * (random() / 2147483648.0 - 1);
    piece.set_point(v, p);
  }
  const auto ratios = [](const TetMesh& mesh) {
    double sum = 0, worst = 1;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      const Corners& c = mesh.corners(t);
      sum += mesh::mean_ratio(mesh.point(c[0]), mesh.point(c[1]), mesh.point(c[2]), mesh.point(c[3]));
      worst = std::min(worst, mesh.quality(t));
    }
    return std::pair(sum / mesh.slot_count(), worst);
  };
  volume(piece);
  TetMesh mesh(piece, measure);
  auto [mean, worst] = ratios(mesh);
  const double first = mean;
  for (int pass = 0; pass < 4; ++pass) {
    MeanRatioSmoothing().run(mesh, 1);
    const auto [next_mean, next_worst] = ratios(mesh);
    EXPECT_GE(next_mean, mean);
    EXPECT_GE(next_worst, worst);
    mean = next_mean, worst = next_worst;
  }
  EXPECT_GT(mean, first + 0.02);
}

TEST(EdgeContraction, RemovesAVertexInsideButNeverOneOnACurve) {
  mesh::Piece piece = make_lattice(4);
  const double before = volume(piece);
  // Two vertices nearly at one place.
  const LocalIndex from = vertex_at(piece, {1.5, 1.5, 1.5}), to = vertex_at(piece, {2, 2, 2});
  piece.set_point(from, {1.93, 1.93, 1.93});
  volume(piece);
  TetMesh mesh(piece, measure);
  EdgeContraction contraction;
  CavityReplacement cavity;
  ASSERT_TRUE(contraction.propose(mesh, from, to, -1, cavity));
  EXPECT_GT(cavity.after, cavity.before);
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  EXPECT_FALSE(mesh.is_used(from));
  mesh.finish();
  EXPECT_NEAR(volume(piece), before, 1e-12);

  mesh::Piece curved = make_lattice(4);
  const LocalIndex stays = vertex_at(curved, {1.5, 1.5, 1.5});
  curved.set_point(stays, {1.93, 1.93, 1.93});
  curved.vertex_dimension[stays] = mesh::CadDimension::edge;
  TetMesh fixed(curved, measure);
  EXPECT_FALSE(contraction.propose(fixed, stays, vertex_at(curved, {2, 2, 2}), -1, cavity));
}

/// A regular icosahedron as twenty tetrahedra around a vertex inside.
mesh::Piece make_icosahedron(geometry::Vec3 inside) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<geometry::Vec3> points;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      points.push_back({0, a, b}), points.push_back({a, b, 0}), points.push_back({b, 0, a});
    }
  }
  points.push_back(inside);
  std::vector<mesh::LocalIndex> cells;
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        const auto is_edge = [&](int a, int b) { return distance(points[a], points[b]) < 2.1; };
        if (!is_edge(i, j) || !is_edge(j, k) || !is_edge(k, i)) continue;
        const bool positive = geometry::volume6(points[i], points[j], points[k], inside) > 0;
        cells.insert(cells.end(), {i, positive ? j : k, positive ? k : j, 12});
      }
    }
  }
  mesh::Piece piece = make_piece(points, cells);
  close_boundary(piece);
  piece.vertex_dimension[12] = mesh::CadDimension::region;
  return piece;
}

TEST(MeanRatioSmoothing, BringsAVertexToTheMiddle) {
  for (const geometry::Vec3 from : {geometry::Vec3{0.7, 0, 0}, {0.3, -0.8, 0.4}, {-0.1, 0.6, 0.6}}) {
    mesh::Piece piece = make_icosahedron(from);
    ASSERT_EQ(piece.cell_count(), 20);
    TetMesh mesh(piece, measure);
    EXPECT_GT(MeanRatioSmoothing().run(mesh, 20), 0);
    EXPECT_LT(norm(mesh.point(12)), 0.1 * norm(from)) << from.x << ' ' << from.y << ' ' << from.z;
  }
}

/// The first step goes straight down the sum of inverse mean ratios.
TEST(MeanRatioSmoothing, StepsAlongTheGradient) {
  for (const geometry::Vec3 from : {geometry::Vec3{0.7, 0, 0.1}, {0.3, -0.8, 0.4}, {-0.1, 0.2, 0.9}}) {
    mesh::Piece piece = make_icosahedron(from);
    // A body without symmetry, or every wrong sum would point to its middle too.
    for (LocalIndex v = 0; v < 12; ++v) piece.set_point(v, 1.0 / (1 + 0.08 * (v % 5)) * piece.point(v));
    const mesh::Piece before = piece;
    TetMesh mesh(piece, measure);
    const auto sum_at = [&](geometry::Vec3 p) {
      double sum = 0;
      for (LocalIndex t = 0; t < before.cell_count(); ++t) {
        std::array<geometry::Vec3, 4> c;
        for (int k = 0; k < 4; ++k) c[k] = before.cell(t)[k] == 12 ? p : before.point(before.cell(t)[k]);
        sum += 1 / mesh::mean_ratio(c[0], c[1], c[2], c[3]);
      }
      return sum;
    };
    geometry::Vec3 downhill;
    for (int axis = 0; axis < 3; ++axis) {
      geometry::Vec3 left = from, right = from;
      left[axis] -= 1e-5, right[axis] += 1e-5;
      downhill[axis] = sum_at(left) - sum_at(right);
    }
    ASSERT_EQ(MeanRatioSmoothing().run(mesh, 1), 1);
    const geometry::Vec3 step = mesh.point(12) - from;
    EXPECT_GT(dot(step, downhill), (1 - 1e-6) * norm(step) * norm(downhill));
  }
}

}  // namespace
}  // namespace aeroloom::improve
