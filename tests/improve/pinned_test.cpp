#include "improve/pinned.hpp"

#include "parallel/environment.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using mesh::DistributedMesh;
using mesh::Piece;

/// Tetrahedra around the z axis that together fill a wedge of `angle` degrees between the faces 0 and 1, one
/// piece for each; the other sides belong to face 2.
DistributedMesh make_wedge(const parallel::Communicator& communicator, double angle, int tets,
                           int dimension) {
  DistributedMesh mesh;
  mesh.piece_count = tets;
  mesh.patches = mesh.faces = {"upper", "lower", "outer"};
  for (int i = 0; i < tets; ++i) {
    if (i % communicator.size() != communicator.rank()) continue;
    Piece piece;
    piece.id = i;
    piece.coordinates = {0, 0, -1, 0, 0, 1};
    for (const int k : {i, i + 1}) {
      const double turn = angle * k / tets * std::numbers::pi / 180;
      piece.coordinates.insert(piece.coordinates.end(), {std::cos(turn), std::sin(turn), 0});
    }
    const auto on_axis = static_cast<std::int8_t>(dimension);
    piece.vertex_dimension = {on_axis, on_axis, 2, 2};
    piece.vertex_entity = {7, 7, 2, 2};
    piece.cells = {0, 1, 2, 3};
    const auto add = [&](std::array<int, 3> corners, int face) {
      piece.boundary.insert(piece.boundary.end(), corners.begin(), corners.end());
      piece.triangle_face.push_back(face);
      piece.triangle_patch.push_back(face);
    };
    add({1, 2, 3}, 2);
    add({0, 3, 2}, 2);
    if (i == 0) add({0, 2, 1}, 0);
    if (i == tets - 1) add({0, 1, 3}, 1);
    piece.shared_vertices = {0, 1, 2, 3};
    piece.shared_tokens = {0, 1, mesh::SharedToken(2 + i), mesh::SharedToken(3 + i)};
    mesh.pieces.push_back(piece);
  }
  return mesh;
}

PinnedReport find(double angle, int tets, int dimension, double target) {
  const auto world = parallel::Communicator::world();
  const DistributedMesh mesh = make_wedge(world, angle, tets, dimension);
  const mesh::Numbering numbering = mesh::number_mesh(world, mesh);
  mesh::CellsBeyond suspects{suspect_angles(target), {}};
  mesh::summarise_quality(world, mesh, numbering, &suspects);
  return find_pinned(world, mesh, numbering, target, suspects);
}

TEST(Pinned, FindsTheFacesThatForceAnAngle) {
  const PinnedReport report = find(12, 3, 1, 15);
  ASSERT_EQ(report.entities.size(), 1u);
  const PinningEntity& entity = report.entities[0];
  EXPECT_EQ(entity.kind, PinningEntity::Kind::faces);
  EXPECT_EQ(entity.faces, (std::array<std::int32_t, 2>{0, 1}));
  EXPECT_NEAR(entity.angle, 12, 1e-9);
  EXPECT_NEAR(entity.smallest_dihedral, 4, 1e-6);
  EXPECT_NEAR(norm(entity.at), 0, 1e-15);
  EXPECT_EQ(entity.tetrahedra, 3);
  EXPECT_EQ(report.tetrahedra, 3);
  EXPECT_EQ(report.others, 0);
  EXPECT_EQ(report.smallest_angle, 15);
}

TEST(Pinned, DoesNotExcuseWhatTheCadAllows) {
  // Enough room for one tetrahedron, filled with four.
  const PinnedReport roomy = find(24, 4, 1, 15);
  EXPECT_TRUE(roomy.entities.empty());
  EXPECT_EQ(roomy.others, 4);
  EXPECT_NEAR(roomy.smallest_angle, 6, 1e-6);
  // No curve there.
  const PinnedReport smooth = find(12, 3, 2, 15);
  EXPECT_TRUE(smooth.entities.empty());
  EXPECT_EQ(smooth.others, 3);
}

TEST(Pinned, ListsNothingOfAGoodMesh) {
  const PinnedReport report = find(60, 1, 1, 15);
  EXPECT_TRUE(report.entities.empty());
  EXPECT_EQ(report.tetrahedra + report.others, 0);
}

}  // namespace
}  // namespace aeroloom::improve
