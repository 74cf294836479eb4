#include "layers/directions.hpp"

#include "layers/cone.hpp"
#include "mesh/exchange/delivery.hpp"
#include "tests/layers/directed_wall.hpp"
#include "tests/several_ranks.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;
using parallel::Communicator;

using Directed = examples::DirectedWall;
using examples::cube_in_a_box;
using examples::layers_on;

TEST(Directions, PointIntoTheFluidOffEdgesAndCorners) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube_in_a_box().distribute(world, 7);
  const Directed directed(mesh, layers_on(2));
  for (std::int32_t v = 0; v < directed.wall.vertex_count(); ++v) {
    const Vec3 p = directed.wall.points[v], d = directed.directions.most_normal[v];
    ASSERT_EQ(directed.stars.kinds[v], StarKind::plain);
    ASSERT_NEAR(norm(d), 1, 1e-14);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double end : {0.0, 1.0, -4.0, 5.0}) {
        if (p[axis] != end) continue;
        const double into_fluid = end == 1 || end == -4 ? d[axis] : -d[axis];
        EXPECT_GT(into_fluid, 0.57) << "at least 1 / sqrt(3)";
      }
    }
  }
}

TEST(Directions, AreSmoothedWithoutLosingSight) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube_in_a_box().distribute(world, 7);
  const Directed directed(mesh, layers_on(2));
  std::int64_t moved = 0;
  for (std::int32_t v = 0; v < directed.wall.vertex_count(); ++v) {
    const auto normals = directed.stars.normals_at(v);
    const double best = visibility_of(directed.directions.most_normal[v], normals);
    EXPECT_GE(directed.directions.visibility[v], 0.9 * best - 1e-14);
    EXPECT_EQ(directed.directions.visibility[v], visibility_of(directed.directions.smoothed[v], normals));
    EXPECT_NEAR(norm(directed.directions.smoothed[v]), 1, 1e-14);
    moved += distance(directed.directions.smoothed[v], directed.directions.most_normal[v]) > 0.05;
  }
  EXPECT_GT(world.sum(moved), 20) << "beside the edges";
}

TEST(Directions, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  const mesh::DistributedMesh mesh = cube_in_a_box().distribute(world, 7),
                              whole = cube_in_a_box().distribute(self, 7);
  const Directed spread(mesh, layers_on(2)), alone(whole, layers_on(2));
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const std::int32_t from = alone.wall.first_vertex[mesh::position_of(whole, mesh.pieces[p].id)];
    for (std::int32_t v = spread.wall.first_vertex[p]; v < spread.wall.first_vertex[p + 1]; ++v) {
      const std::int32_t other = from + v - spread.wall.first_vertex[p];
      EXPECT_EQ(spread.directions.smoothed[v], alone.directions.smoothed[other]);
      EXPECT_EQ(spread.directions.visibility[v], alone.directions.visibility[other]);
      EXPECT_EQ(spread.stars.kinds[v], alone.stars.kinds[other]);
    }
  }
}

TEST(Directions, AreEqualInAllPiecesThatKnowAVertex) {
  const auto self = Communicator::self();
  const mesh::DistributedMesh mesh = cube_in_a_box().distribute(self, 7);
  const Directed directed(mesh, layers_on(2));
  std::map<mesh::SharedVertexKey, Vec3> known;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (std::size_t s = 0; s < mesh.pieces[p].shared_keys.size(); ++s) {
      const Vec3 d =
          directed.directions.smoothed[directed.wall.first_vertex[p] + mesh.pieces[p].shared_vertices[s]];
      EXPECT_EQ(known.emplace(mesh.pieces[p].shared_keys[s], d).first->second, d);
    }
  }
  EXPECT_GT(known.size(), 20u);
}

TEST(Directions, AreNoneBesideFacesWhereLayersMayNotEnd) {
  const auto self = Communicator::self();
  mesh::DistributedMesh mesh = cube_in_a_box().distribute(self, 2);
  mesh.patches.emplace_back("other");
  for (mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const bool top = std::all_of(piece.cell(t), piece.cell(t) + 3,
                                   [&](mesh::LocalIndex v) { return piece.point(v).z == 1; });
      if (top) piece.triangle_patch[t] = 2;
    }
  }
  const Directed directed(mesh, layers_on(2));
  for (std::int32_t v = 0; v < directed.wall.vertex_count(); ++v) {
    const Vec3 p = directed.wall.points[v];
    if (p.z != 1) continue;
    const bool rim = p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1;
    EXPECT_EQ(directed.stars.kinds[v], rim ? StarKind::ending : StarKind::off_wall);
    EXPECT_EQ(directed.directions.smoothed[v], Vec3{});
  }
}

TEST(Directions, AreNoneOnFacesBetweenTwoRegions) {
  const auto self = Communicator::self();
  mesh::DistributedMesh mesh = cube_in_a_box().distribute(self, 2);
  mesh.regions = {"outer", "inner"};
  mesh.sides = {{0, mesh::no_region}, {0, 1}};
  const Directed directed(mesh, layers_on(2));
  for (std::int32_t v = 0; v < directed.wall.vertex_count(); ++v) {
    const bool on_box = norm(directed.wall.points[v] - Vec3{0.5, 0.5, 0.5}) > 2;
    EXPECT_EQ(directed.stars.kinds[v], on_box ? StarKind::plain : StarKind::off_wall);
  }
}

TEST(Directions, AreNoneWhereTwoFansMeet) {
  // Two cubes with a common corner: the vertex is on two stars.
  const auto self = Communicator::self();
  examples::Shapes shapes;
  shapes.add_box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, examples::Fluid::outside);
  shapes.add_box({1, 1, 1}, {2, 2, 2}, {2, 2, 2}, examples::Fluid::outside);
  shapes.merge_points();
  const mesh::DistributedMesh mesh = shapes.distribute(self, 3);
  const Directed directed(mesh, layers_on(2));
  int broken = 0;
  for (std::int32_t v = 0; v < directed.wall.vertex_count(); ++v) {
    if (directed.stars.kinds[v] == StarKind::plain) continue;
    EXPECT_EQ(directed.stars.kinds[v], StarKind::broken);
    EXPECT_EQ(directed.wall.points[v], (Vec3{1, 1, 1}));
    ++broken;
  }
  EXPECT_GE(broken, 1);
}

}  // namespace
}  // namespace aeroloom::layers
