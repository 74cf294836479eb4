/// The loops of faces, from the pieces of a surface mesh.
#include "surface/curves/face_loops.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;
using mesh::SharedVertexKey;
using parallel::Communicator;

mesh::Piece flat_piece(cad::FaceId face, const std::vector<Vec3>& points, std::vector<mesh::LocalIndex> cells,
                       std::vector<SharedVertexKey> keys) {
  mesh::Piece piece;
  piece.id = face;
  piece.kind = mesh::CellKind::triangle;
  for (const Vec3& p : points) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  piece.triangle_face.assign(cells.size() / 3, face);
  piece.cells = std::move(cells);
  for (std::size_t v = 0; v < keys.size(); ++v)
    piece.shared_vertices.push_back(static_cast<mesh::LocalIndex>(v));
  piece.shared_keys = std::move(keys);
  return piece;
}

/// A sheet stands on a square: its curve is a loop of the square, passed both ways. An edge inside between
/// two vertices of the boundary is none.
TEST(FaceLoopsLocal, PassACurveInsideTheFaceBothWays) {
  const Communicator self = Communicator::self();
  mesh::DistributedMesh surface(self);
  surface.kind = mesh::CellKind::triangle;
  surface.piece_count = 2;
  // Corners 1 to 4 of the square, named by ten times as much; from the middle 0 a curve runs to corner 1.
  surface.pieces.push_back(flat_piece(0, {{0.5, 0.5, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                      {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}, {5, 10, 20, 30, 40}));
  surface.pieces.push_back(flat_piece(1, {{0, 0, 0}, {0.5, 0.5, 0}, {0, 0, 1}}, {0, 1, 2}, {10, 5, 50}));
  const std::vector<cad::FaceId> faces{0};
  const auto loops = gather_loops(surface, faces);
  ASSERT_EQ(loops.size(), 1u);
  const FaceLoops& square = loops.at(0);
  EXPECT_EQ(square.vertex_keys, (std::vector<SharedVertexKey>{5, 10, 20, 30, 40}));
  EXPECT_EQ(square.points[2], (Vec3{1, 0, 0}));
  const std::vector<std::array<std::int32_t, 2>> edges{{0, 1}, {1, 0}, {1, 2}, {2, 3}, {3, 4}, {4, 1}};
  EXPECT_EQ(square.edges, edges);
}

}  // namespace
}  // namespace aeroloom::surface
