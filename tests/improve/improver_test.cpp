#include "improve/improver.hpp"

#include "mesh/exchange/shared_vertices.hpp"
#include "tests/improve/shaken.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::examine;
using examples::expect_valid;
using mesh::DistributedMesh;

TEST(ImproveMesh, RemovesAPlantedSliver) {
  const auto self = parallel::Communicator::self();
  int planted = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    mesh::examples::WholeMesh whole = mesh::examples::whole_cube(4, 1);
    examples::flip_at_random(whole, 1, random);
    DistributedMesh mesh = mesh::examples::distribute(self, whole, 1);
    if (examine(mesh.pieces, 15).angle > 6) continue;
    ++planted;
    EXPECT_EQ(improve_mesh(mesh, {}).bad_after, 0);
    expect_valid(mesh);
  }
  EXPECT_GT(planted, 2);
}

TEST(ImproveMesh, DependsOnThePiecesAlone) {
  const auto world = parallel::Communicator::world();
  const auto self = parallel::Communicator::self();
  const auto improved_hash = [](const parallel::Communicator& communicator, ImproveReport& report) {
    DistributedMesh mesh = mesh::examples::distribute(communicator, examples::shaken_cube(5, 5, 30, 3), 5);
    report = improve_mesh(mesh, {});
    expect_valid(mesh);
    EXPECT_EQ(mesh::SharedVertices(mesh).drop_unshared(mesh), 0) << "vertices of one piece listed as shared";
    return mesh::hash_mesh(mesh::number_mesh(mesh));
  };
  ImproveReport spread, alone, again;
  const std::string hash = improved_hash(self, alone);
  EXPECT_EQ(improved_hash(world, spread), hash);
  EXPECT_EQ(improved_hash(self, again), hash);
  EXPECT_EQ(spread.bad_before, alone.bad_before);
  EXPECT_EQ(spread.bad_after, alone.bad_after);
  EXPECT_EQ(spread.smoothed, alone.smoothed);
  EXPECT_EQ(spread.replaced, alone.replaced);
  EXPECT_EQ(spread.min_angle_before, alone.min_angle_before);
  EXPECT_EQ(spread.min_angle_after, alone.min_angle_after);
}

TEST(ImproveMesh, OnlyLooksWhenDisabled) {
  const auto world = parallel::Communicator::world();
  DistributedMesh mesh = mesh::examples::distribute(world, examples::shaken_cube(4, 3, 10, 5), 3);
  const std::string hash = mesh::hash_mesh(mesh::number_mesh(mesh));
  ImproveOptions options;
  options.enabled = false;
  const ImproveReport report = improve_mesh(mesh, options);
  EXPECT_GT(report.bad_before, 0);
  EXPECT_EQ(report.bad_after, report.bad_before);
  EXPECT_EQ(report.min_angle_after, report.min_angle_before);
  EXPECT_EQ(mesh::hash_mesh(mesh::number_mesh(mesh)), hash);
}

TEST(ImproveMesh, LeavesALatticeAsItIs) {
  const auto self = parallel::Communicator::self();
  constexpr int n = 8, low = 2, high = 6;
  mesh::examples::WholeMesh whole = mesh::examples::whole_cube(n, 1);
  // The second piece is off the boundary.
  const auto is_inside = [&](int v) {
    const geometry::Vec3 p = n * whole.points[v];
    const auto within = [](double t) { return t > low - 0.5 && t < high + 0.5; };
    return within(p.x) && within(p.y) && within(p.z);
  };
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    const std::vector<int>& cell = whole.cells[c];
    whole.piece_of_cell[c] = std::all_of(cell.begin(), cell.end(), is_inside);
  }
  const DistributedMesh before = mesh::examples::distribute(self, whole, 2);
  ASSERT_EQ(before.pieces[1].boundary_count(), 0);
  ASSERT_EQ(examine({before.pieces[1]}, 33).bad, 0);
  const auto moved_inside = [&](double target) {
    DistributedMesh mesh = before;
    ImproveOptions options;
    options.target_angle = target;
    const ImproveReport report = improve_mesh(mesh, options);
    EXPECT_EQ(report.min_angle_before, examine(before.pieces, target).angle);
    expect_valid(mesh);
    int moved = 0;
    const mesh::Piece &was = before.pieces[1], &is = mesh.pieces[1];
    for (mesh::LocalIndex v = 0; v < was.vertex_count(); ++v) {
      const bool shared = std::count(was.shared_vertices.begin(), was.shared_vertices.end(), v) > 0;
      moved += !shared && !(was.point(v) == is.point(v));
    }
    EXPECT_NE(mesh.pieces[0].coordinates, before.pieces[0].coordinates);
    return moved;
  };
  EXPECT_EQ(moved_inside(28), 0);
  EXPECT_GT(moved_inside(34), 0) << "a lattice does not promise that";
}

TEST(ImproveMesh, WorksOnAFewRanksWithoutPieces) {
  const auto world = parallel::Communicator::world();
  DistributedMesh mesh = mesh::examples::distribute(world, examples::shaken_cube(4, 1, 10, 6), 1);
  const ImproveReport report = improve_mesh(mesh, {});
  EXPECT_GT(report.min_angle_after, report.min_angle_before);
  expect_valid(mesh);
}

TEST(ImproveMesh, RefusesWhatItCannotDoOnAllRanks) {
  const auto world = parallel::Communicator::world();
  DistributedMesh mesh = mesh::examples::distribute(world, examples::shaken_cube(3, 1, 0, 7), 1);
  ImproveOptions options;
  options.target_angle = 80;
  EXPECT_THROW(improve_mesh(mesh, options), std::runtime_error);
  DistributedMesh surface(world);
  surface.kind = mesh::CellKind::triangle;
  EXPECT_THROW(improve_mesh(surface, {}), std::runtime_error);
}

}  // namespace
}  // namespace aeroloom::improve
