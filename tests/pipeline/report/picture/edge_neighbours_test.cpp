#include "pipeline/report/picture/edge_neighbours.hpp"

#include "tests/pipeline/report/picture/surfaces.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::picture {
namespace {

using parallel::Communicator;

constexpr double right_angle = std::numbers::pi / 2;

Shown all_shown(const mesh::DistributedMesh& surface) {
  Shown shown;
  for (const mesh::Piece& piece : surface.pieces) shown.emplace_back(piece.cell_count(), 1);
  return shown;
}

class FoldsOfCube : public testing::TestWithParam<int> {};

TEST_P(FoldsOfCube, KnowEveryNeighbourWhateverThePieces) {
  const Communicator world = Communicator::world();
  const mesh::DistributedMesh cube = mesh::examples::cube_surface(world, 4, GetParam());
  const EdgeNeighbours neighbours = find_edge_neighbours(mesh::number_mesh(cube), all_shown(cube));
  std::int64_t open = 0, flat = 0, creases = 0;
  for (std::size_t p = 0; p < cube.pieces.size(); ++p) {
    const mesh::Piece& piece = cube.pieces[p];
    ASSERT_EQ(neighbours[p].size(), 3U * piece.cell_count());
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const geometry::Vec3 normal = normalized(area_normal(piece, t));
      for (int i = 0; i < 3; ++i) {
        const EdgeNeighbour& neighbour = neighbours[p][3 * t + i];
        const geometry::Vec3 edge = piece.point(piece.cell(t)[(i + 1) % 3]) - piece.point(piece.cell(t)[i]);
        const double angle = angle_at(normal, edge, neighbour);
        open += neighbour.is_open() || !neighbour.shown;
        flat += std::abs(angle) < 1e-12 && neighbour.face == piece.triangle_face[t];
        // The flow is inside: edges of the cube are creases for it.
        creases += std::abs(angle + right_angle) < 1e-12 && neighbour.face != piece.triangle_face[t];
      }
    }
  }
  EXPECT_EQ(world.sum(open), 0);
  EXPECT_EQ(world.sum(creases), 2 * 12 * 4);
  EXPECT_EQ(world.sum(flat), 3 * 6 * 2 * 16 - 2 * 12 * 4);
}

INSTANTIATE_TEST_SUITE_P(Pieces, FoldsOfCube, testing::Values(1, 2, 7, 24));

TEST(EdgeNeighbours, OpenEdgesAndThoseOfSeveralTrianglesAreKnown) {
  const Communicator world = Communicator::world();
  examples::SurfaceBuilder builder;
  // Three sheets that meet at the z axis.
  for (const geometry::Vec3 out :
       {geometry::Vec3{1, 0, 0}, geometry::Vec3{0, 1, 0}, geometry::Vec3{-1, 0, 0}}) {
    builder.add_grid(
        2, 3,
        [&](double s, double t) {
          return s * out + geometry::Vec3{0, 0, t};
        },
        0);
  }
  const mesh::DistributedMesh sheets = builder.distribute(world, {"sheets"});
  std::int64_t open = 0, several = 0;
  for (const auto& of_piece : find_edge_neighbours(mesh::number_mesh(sheets), all_shown(sheets))) {
    for (const EdgeNeighbour& neighbour : of_piece) open += neighbour.is_open(), several += neighbour.several;
  }
  EXPECT_EQ(world.sum(several), 3 * 3);
  EXPECT_EQ(world.sum(open), 3 * (2 + 2 + 3));
}

}  // namespace
}  // namespace aeroloom::picture
