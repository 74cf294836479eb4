#include "improve/improver.hpp"
#include "tests/improve/shaken.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::examine;
using examples::expect_valid;
using examples::Extremes;
using geometry::Vec3;
using mesh::DistributedMesh;
using mesh::LocalIndex;
using mesh::Piece;

/// The points of shared vertices by token.
std::map<mesh::SharedToken, std::array<double, 3>> shared_points(const Piece& piece) {
  std::map<mesh::SharedToken, std::array<double, 3>> points;
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    const Vec3 p = piece.point(piece.shared_vertices[s]);
    points[piece.shared_tokens[s]] = {p.x, p.y, p.z};
  }
  return points;
}

/// The corners of the boundary triangles in order.
std::vector<double> boundary_points(const Piece& piece) {
  std::vector<double> points;
  for (const LocalIndex v : piece.boundary) {
    const Vec3 p = piece.point(v);
    points.insert(points.end(), {p.x, p.y, p.z});
  }
  return points;
}

class RandomMesh : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomMesh, GetsBetterAndKeepsItsBoundary) {
  const auto self = parallel::Communicator::self();
  const int pieces = 1 + GetParam() % 3;
  DistributedMesh mesh =
      mesh::examples::distribute(self, examples::shaken_cube(5, pieces, 25, GetParam()), pieces);
  expect_valid(self, mesh);
  const ImproveOptions options;
  const Extremes before = examine(mesh.pieces, options.target_angle);
  const std::vector<Piece> old = mesh.pieces;
  parallel::StageClock clock;
  const ImproveReport report = improve_mesh(self, mesh, options, clock);
  const Extremes after = examine(mesh.pieces, options.target_angle);
  expect_valid(self, mesh);
  EXPECT_GT(after.quality, before.quality);
  // Interfaces are shaken too, but must stay as they are.
  EXPECT_GT(after.angle, pieces == 1 ? 12 : 3) << "from " << before.angle;
  EXPECT_LT(after.bad, before.bad / 4);
  EXPECT_EQ(report.bad_before, before.bad);
  EXPECT_EQ(report.bad_after, after.bad);
  EXPECT_EQ(report.min_angle_before, before.angle);
  EXPECT_EQ(report.min_angle_after, after.angle);
  EXPECT_GT(report.swaps, 0);
  EXPECT_GT(report.smoothed, 0);
  for (std::size_t p = 0; p < old.size(); ++p) {
    EXPECT_EQ(boundary_points(mesh.pieces[p]), boundary_points(old[p]));
    EXPECT_EQ(mesh.pieces[p].triangle_face, old[p].triangle_face);
    EXPECT_EQ(mesh.pieces[p].triangle_patch, old[p].triangle_patch);
    EXPECT_EQ(shared_points(mesh.pieces[p]), shared_points(old[p]));
    EXPECT_TRUE(std::is_sorted(mesh.pieces[p].shared_vertices.begin(), mesh.pieces[p].shared_vertices.end()));
  }
}

// What improved once is worked on again with a higher target: states no random mesh starts from.
TEST_P(RandomMesh, NeverGetsWorseWhenRepeated) {
  const auto self = parallel::Communicator::self();
  DistributedMesh mesh =
      mesh::examples::distribute(self, examples::shaken_cube(4, 1, 25, 100 + GetParam()), 1);
  parallel::StageClock clock;
  for (const double target : {5.0, 15.0, 30.0}) {
    ImproveOptions options;
    options.target_angle = target;
    options.sweeps = 4;
    const double before = examine(mesh.pieces, target).quality;
    improve_mesh(self, mesh, options, clock);
    EXPECT_GE(examine(mesh.pieces, target).quality, before);
    expect_valid(self, mesh);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMesh, testing::Range(0u, 12u));

}  // namespace
}  // namespace aeroloom::improve
