// Edges at which a piece of a surface pinches itself.
#include "surface/pinched_edges.hpp"

#include "mesh/data/distributed_mesh.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

/// On each rank a piece of triangles over the corners of a cube; the length of its edges is two.
std::vector<PinchedEdge> pinched(const std::vector<mesh::LocalIndex>& triangles) {
  mesh::DistributedMesh surface(parallel::Communicator::world());
  surface.piece_count = surface.communicator.size();
  mesh::Piece piece;
  piece.id = surface.communicator.rank();
  piece.kind = mesh::CellKind::triangle;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) piece.coordinates.push_back((corner >> axis & 1) != 0 ? 2 : 0);
  piece.cells = triangles;
  surface.pieces.push_back(std::move(piece));
  return find_pinched_edges(surface);
}

TEST(PinchedEdges, OfATubeWithTwoElementsAround) {
  EXPECT_TRUE(pinched({0, 1, 3, 0, 3, 2, 2, 3, 7}).empty());
  // Two bands of a tube have the edge 0-1 in common.
  const std::vector<PinchedEdge> found = pinched({0, 1, 2, 1, 0, 3, 0, 1, 4, 1, 0, 5});
  ASSERT_EQ(found.size(), static_cast<std::size_t>(parallel::Communicator::world().size()));
  for (std::size_t piece = 0; piece < found.size(); ++piece) {
    EXPECT_EQ(found[piece].piece, static_cast<mesh::PieceId>(piece));
    EXPECT_EQ(found[piece].length, 2);
    EXPECT_EQ(found[piece].middle.x, 1);
    EXPECT_EQ(found[piece].middle.y, 0);
  }
}

TEST(PinchedEdges, OfTwoTrianglesWithEqualCorners) {
  EXPECT_FALSE(pinched({0, 1, 2, 2, 1, 0}).empty());
}

}  // namespace
}  // namespace aeroloom::surface
