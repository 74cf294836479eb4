#include "mesh/quality/face_links.hpp"

#include "tests/meshes/mixed_mesh.hpp"

#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

TEST(FaceLinks, AreMutualAndLeaveNothingOpen) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(3, 4);
  const DistributedMesh mesh = examples::distribute(world, whole, 4);
  const FaceLinks links = link_faces(number_mesh(mesh));
  EXPECT_EQ(links.defects.crowded_faces + links.defects.stray_faces + links.defects.repeated_faces, 0);
  EXPECT_EQ(links.defects.open_faces, 0);
  GlobalIndex inner = 0, boundary = 0, both = 0, wanted = 0, outside = 0, between = 0;
  for (const PieceLinks& piece : links.pieces) {
    for (std::size_t s = 0; s < piece.neighbours.size(); ++s) {
      const bool bounded = piece.boundary_face[s] >= 0, linked = piece.neighbours[s].exists();
      EXPECT_TRUE(bounded || linked);
      inner += linked ? 1 : 0;
      boundary += bounded && !linked ? 1 : 0;
      both += bounded && linked ? 1 : 0;
    }
  }
  for (const examples::WholeCell& cell : whole.cells)
    wanted += static_cast<GlobalIndex>(faces_of(cell.shape).size());
  for (const examples::WholeFace& face : whole.faces)
    ++(face.patch == examples::MixedMesh::interface ? between : outside);
  EXPECT_EQ(world.sum(inner + boundary), wanted);
  EXPECT_EQ(world.sum(boundary), outside);
  EXPECT_GE(world.sum(both), between);
}

TEST(FaceLinks, CountWhatDoesNotFit) {
  const Communicator world = Communicator::world();
  const auto defects_of = [&](const auto& spoil) {
    DistributedMesh mesh = examples::mixed_mesh(world, 3, 2);
    for (Piece& piece : mesh.pieces) {
      if (piece.id == 0) spoil(piece);
    }
    return link_faces(number_mesh(mesh)).defects;
  };
  EXPECT_EQ(defects_of([](Piece& piece) {
              piece.quads.resize(piece.quads.size() - 4);
              piece.quad_face.pop_back(), piece.quad_patch.pop_back();
            }).open_faces,
            1);
  EXPECT_EQ(defects_of([](Piece& piece) {
              piece.quads.insert(piece.quads.end(), piece.quads.begin(), piece.quads.begin() + 4);
              piece.quad_face.push_back(piece.quad_face[0]), piece.quad_patch.push_back(piece.quad_patch[0]);
            }).repeated_faces,
            1);
  EXPECT_GT(defects_of([](Piece& piece) {
              for (int copy = 0; copy < 2; ++copy)
                piece.prisms.insert(piece.prisms.end(), piece.prisms.begin(), piece.prisms.begin() + 6);
              for (RegionRun& run : piece.runs) run.end += &run == &piece.runs.back() ? 2 : 0;
            }).crowded_faces,
            0);
  EXPECT_EQ(defects_of([](Piece& piece) {
              const std::set<LocalIndex> corners(piece.quads.begin(), piece.quads.begin() + 4);
              while (corners.count(piece.quads[0])) ++piece.quads[0];
            }).stray_faces,
            1);
}

}  // namespace
}  // namespace aeroloom::mesh
