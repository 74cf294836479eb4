#include "mesh/transfer/split_pieces.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/exchange/delivery.hpp"
#include "tests/meshes/wall_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

/// A ball within a box, two CAD faces.
DistributedMesh ball_in_box(const Communicator& communicator, int slices) {
  return layers::examples::Shapes()
      .add_box({-5, -5, -5}, {5, 5, 5}, {6, 6, 6}, layers::examples::Fluid::inside)
      .add_sphere({0, 0, 0}, 1, 8, layers::examples::Fluid::outside)
      .distribute_faces(communicator, slices);
}

TEST(SplitPieces, KeepTheMeshInSmallerPieces) {
  const auto world = Communicator::world();
  const DistributedMesh surface = ball_in_box(world, 2);
  const MeshCounts before = count_mesh(number_mesh(surface));
  const NumberedMesh split = split_pieces(surface, 50, {});
  const MeshCounts after = count_mesh(split);
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.cells, before.cells);
  // Halves of 432 and of 768 triangles.
  EXPECT_EQ(split.piece_count, 2 * 5 + 2 * 8);
  for (const Piece& piece : split.pieces) {
    EXPECT_LE(piece.cell_count(), 50);
    EXPECT_GE(piece.cell_count(), 40);
    require_consistent_arrays(piece);
  }
  EXPECT_TRUE(check_surface_mesh(split).valid());
}

TEST(SplitPieces, LeaveWholeFacesAlone) {
  const auto world = Communicator::world();
  const NumberedMesh split = split_pieces(ball_in_box(world, 1), 50, {0});
  std::vector<std::int32_t> of_box;
  for (const Piece& piece : split.pieces) of_box.push_back(piece.common_face() == 0 ? 1 : 0);
  of_box = gather_by_piece(split, of_box);
  EXPECT_EQ(std::count(of_box.begin(), of_box.end(), 1), 1);
  EXPECT_EQ(of_box.size(), 1u + 16u);
}

TEST(SplitPieces, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash_of = [](const Communicator& communicator) {
    const NumberedMesh split = split_pieces(ball_in_box(communicator, 3), 40, {});
    return hash_mesh(split);
  };
  EXPECT_EQ(hash_of(Communicator::world()), hash_of(Communicator::self()));
}

TEST(SplitPieces, AreSpreadOverRanks) {
  const auto world = Communicator::world();
  const NumberedMesh split = split_pieces(ball_in_box(world, 1), 20, {});
  std::int64_t mine = 0;
  for (const Piece& piece : split.pieces) mine += piece.cell_count();
  EXPECT_LE(world.size() * mine, 1.1 * static_cast<double>(world.sum(mine)));
}

// One large piece of little load must not make all others share the ranks that it leaves.
TEST(SplitPieces, AreSpreadOverRanksByTheirLoads) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world();
  const auto is_box = [](const Piece& piece) { return piece.common_face() == 0; };
  const NumberedMesh split = split_pieces(ball_in_box(world, 1), 20, {0}, [&](const Piece& piece) {
    return is_box(piece) ? 1.0 : static_cast<double>(piece.cell_count());
  });
  std::int64_t mine = 0;
  for (const Piece& piece : split.pieces) mine += is_box(piece) ? 0 : piece.cell_count();
  EXPECT_LE(world.size() * mine, 1.1 * static_cast<double>(world.sum(mine)));
}

}  // namespace
}  // namespace aeroloom::mesh
