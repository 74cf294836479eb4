#include "improve/operations/cavity_insertion.hpp"
#include "improve/operations/edge_removal.hpp"
#include "improve/operations/face_removal.hpp"
#include "improve/operations/smoothing.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "mesh/quality/quality.hpp"
#include "tests/improve/pieces.hpp"

#include <algorithm>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::make_octahedron;
using examples::make_octahedron_with_sliver;
using examples::make_piece;
using examples::make_prism_with_flat_tet;
using examples::make_spindle;
using examples::volume;

const mesh::TetQuality measure(15);

TEST(TetQuality, FallsBelowTheTargetExactlyWithTheAngles) {
  std::mt19937 random(1);
  const auto uniform = [&] { return random() / 4294967296.0; };
  int bad = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3 p[4];
    for (Vec3& q : p) q = {uniform(), uniform(), uniform()};
    if (volume6(p[0], p[1], p[2], p[3]) < 0) {
      EXPECT_LE(measure(p[0], p[1], p[2], p[3]), 0);
      std::swap(p[0], p[1]);
    }
    const mesh::DihedralRange range = mesh::dihedral_range(p[0], p[1], p[2], p[3]);
    if (std::abs(range.smallest - 15) < 1e-6 || std::abs(range.largest - 157.5) < 1e-6) continue;
    const bool misses = range.smallest < 15 || range.largest > 157.5;
    bad += misses;
    EXPECT_EQ(measure(p[0], p[1], p[2], p[3]) < measure.target(), misses);
    EXPECT_NEAR(measure(p[0], p[1], p[2], p[3]), measure(p[1], p[2], p[0], p[3]), 1e-12);
  }
  EXPECT_GT(bad, 1000);
}

TEST(TetQuality, IsNotPositiveWithoutVolume) {
  EXPECT_LE(measure({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
  EXPECT_LE(measure({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}), 0);
  EXPECT_LE(measure({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), 0);
  EXPECT_FALSE(geometry::has_positive_volume({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}));
  EXPECT_TRUE(geometry::has_positive_volume({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-300}));
}

TEST(TetMesh, KeepsCellsThatNobodyChanges) {
  mesh::Piece piece = make_spindle(5);
  const auto cells = piece.cells;
  const auto coordinates = piece.coordinates;
  TetMesh mesh(piece, measure);
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) EXPECT_TRUE(mesh.is_fixed(v));
  mesh.finish();
  EXPECT_EQ(piece.cells, cells);
  EXPECT_EQ(piece.coordinates, coordinates);
}

TEST(TetMesh, RemovesUnusedVerticesFromAllArrays) {
  // A tetrahedron split at its inner vertex 0.
  mesh::Piece piece = make_piece({{0.2, 0.2, 0.2}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {0, 2, 3, 4, 1, 0, 3, 4, 1, 2, 0, 4, 1, 2, 3, 0});
  piece.vertex_entity = {7, 1, 2, 3, 4};
  piece.vertex_dimension = {mesh::CadDimension::region, mesh::CadDimension::vertex,
                            mesh::CadDimension::vertex, mesh::CadDimension::vertex,
                            mesh::CadDimension::vertex};
  piece.boundary = {1, 3, 2};
  piece.shared_vertices = {2, 4};
  TetMesh mesh(piece, measure);
  EXPECT_FALSE(mesh.is_fixed(0));
  CavityReplacement cavity;
  cavity.old_tets = {0, 1, 2, 3};
  cavity.new_tets = {{1, 2, 3, 4}};
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  EXPECT_FALSE(mesh.is_used(0));
  mesh.finish();
  EXPECT_EQ(piece.cells, (std::vector<LocalIndex>{0, 1, 2, 3}));
  EXPECT_EQ(piece.boundary, (std::vector<LocalIndex>{0, 2, 1}));
  EXPECT_EQ(piece.shared_vertices, (std::vector<LocalIndex>{1, 3}));
  EXPECT_EQ(piece.vertex_entity, (std::vector<std::int32_t>{1, 2, 3, 4}));
  EXPECT_EQ(piece.vertex_count(), 4);
  EXPECT_NEAR(volume(piece), 1.0 / 6, 1e-15);
}

TEST(TetMesh, RefusesAFillingWithOtherFaces) {
  mesh::Piece piece = make_spindle(4);
  TetMesh mesh(piece, measure);
  CavityReplacement cavity;
  cavity.old_tets = {0, 1};
  cavity.new_tets = {{0, 1, 2, 4}};
  std::vector<LocalIndex> placed;
  EXPECT_THROW(mesh.replace(cavity, placed), std::logic_error);
}

TEST(TetMesh, RefusesThreeTetrahedraAtAFace) {
  mesh::Piece piece = make_piece({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}},
                                 {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5});
  EXPECT_THROW(TetMesh(piece, measure), std::logic_error);
}

class Ring : public testing::TestWithParam<int> {};

TEST_P(Ring, LosesItsEdge) {
  const int count = GetParam();
  mesh::Piece piece = make_spindle(count);
  const double before = volume(piece);
  TetMesh mesh(piece, measure);
  EdgeRemoval removal;
  CavityReplacement cavity;
  ASSERT_TRUE(removal.propose(mesh, 1, 0, -1, cavity));
  EXPECT_EQ(cavity.new_tets.size(), 2u * (count - 2));
  EXPECT_GT(cavity.after, cavity.before);
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  double worst = 2;
  for (const LocalIndex t : placed) worst = std::min(worst, mesh.quality(t));
  EXPECT_DOUBLE_EQ(worst, cavity.after);
  mesh.finish();
  EXPECT_EQ(piece.cell_count(), 2 * (count - 2));
  EXPECT_NEAR(volume(piece), before, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Ring, testing::Values(3, 4, 5, 6, 7, 8));

TEST(EdgeRemoval, LeavesBoundaryEdgesAndLargeRingsAlone) {
  EdgeRemoval removal;
  CavityReplacement cavity;
  mesh::Piece large = make_spindle(EdgeRemoval::largest_ring + 1);
  TetMesh large_mesh(large, measure);
  EXPECT_FALSE(removal.propose(large_mesh, 0, 0, -1, cavity));
  mesh::Piece piece = make_spindle(4);
  TetMesh mesh(piece, measure);
  for (int edge = 1; edge < 6; ++edge) EXPECT_FALSE(removal.propose(mesh, 0, edge, -1, cavity));
}

// Flat cones on both sides of a triangulated polygon, whose apices are close together: an edge between them
// is better.
TEST(FaceRemoval, RemovesOneOrSeveralFaces) {
  for (int count = 3; count <= 6; ++count) {
    std::vector<Vec3> points{{0, 0, -0.05}, {0, 0, 0.05}};
    std::vector<LocalIndex> cells;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      points.push_back({0.3 * std::cos(angle), 0.3 * std::sin(angle), 0});
    }
    for (LocalIndex i = 1; i + 1 < count; ++i) {
      cells.insert(cells.end(), {2, 2 + i, 3 + i, 1, 3 + i, 2 + i, 2, 0});
    }
    mesh::Piece piece = make_piece(points, cells);
    const double before = volume(piece);
    TetMesh mesh(piece, mesh::TetQuality(50));
    FaceRemoval removal;
    CavityReplacement best;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      CavityReplacement cavity;
      if (removal.propose(mesh, t, 3, best.after, cavity)) best = cavity;
    }
    ASSERT_TRUE(best.improves()) << count;
    EXPECT_EQ(best.new_tets.size(), best.old_tets.size() / 2 + 2);
    if (count == 4) {
      EXPECT_EQ(best.new_tets.size(), 4u) << "the new edge crosses the edge between the two faces";
    }
    std::vector<LocalIndex> placed;
    mesh.replace(best, placed);
    mesh.finish();
    EXPECT_NEAR(volume(piece), before, 1e-14);
  }
}

TEST(Smoothing, CentresAVertexAndStopsThere) {
  mesh::Piece piece = make_octahedron({0.5, 0.3, 0.15});
  TetMesh mesh(piece, mesh::TetQuality(50));
  const ChangeLimits any;
  Smoothing smoothing(any);
  std::vector<LocalIndex> star;
  ASSERT_TRUE(smoothing.smooth(mesh, 0, star));
  EXPECT_EQ(star.size(), 8u);
  while (smoothing.smooth(mesh, 0, star)) {
  }
  EXPECT_LT(norm(mesh.point(0)), 0.02);
}

TEST(CavityInsertion, PlacesANewVertexInAFlatCavity) {
  mesh::Piece piece = make_octahedron_with_sliver();
  const double before = volume(piece);
  TetMesh mesh(piece, measure);
  CavityInsertion insertion;
  CavityReplacement cavity;
  ASSERT_TRUE(insertion.propose_new_vertex(mesh, 4, 0, cavity));
  EXPECT_EQ(cavity.old_tets.size(), 5u);
  mesh.add_vertex(insertion.position(), 0);
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  for (const LocalIndex t : placed) EXPECT_GE(mesh.quality(t), cavity.after * (1 - 1e-9));
  mesh.finish();
  EXPECT_EQ(piece.vertex_count(), 7);
  EXPECT_EQ(piece.vertex_dimension.size(), 7u);
  EXPECT_NEAR(volume(piece), before, 1e-14);
}

// No cone from within the flat tetrahedron is any better than it.
TEST(CavityInsertion, GetsRidOfATetrahedronFlatOnTheBoundary) {
  mesh::Piece piece = make_prism_with_flat_tet();
  const double before = volume(piece);
  EXPECT_NEAR(before, 0.8, 1e-8);
  TetMesh mesh(piece, measure);
  CavityInsertion insertion;
  CavityReplacement cavity;
  ASSERT_TRUE(insertion.propose_new_vertex(mesh, 3, 0, cavity));
  EXPECT_LT(cavity.before, 1e-6);
  mesh.add_vertex(insertion.position(), 0);
  std::vector<LocalIndex> placed;
  mesh.replace(cavity, placed);
  mesh.finish();
  EXPECT_NEAR(volume(piece), before, 1e-14);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    EXPECT_GT(mesh::dihedral_range(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]))
                  .smallest,
              10);
  }
}

}  // namespace
}  // namespace aeroloom::improve
