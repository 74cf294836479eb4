#include "improve/operations/small_polyhedron.hpp"

#include "improve/operations/edge_removal.hpp"
#include "tests/improve/pieces.hpp"
#include "tests/improve/shaken.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::make_piece;
using examples::make_spindle;
using examples::volume;

const mesh::TetQuality measure(28);

// A polyhedron that is the edge_ring of an edge has no better filling than the best of its ring: fillings
// that keep the edge are one of those it chooses from.
TEST(SmallPolyhedron, DoesAsWellAsEdgeRemovalOnARing) {
  for (int count = 3; count <= 7; ++count) {
    mesh::Piece piece = make_spindle(count, 0.9);
    const double before = volume(piece);
    TetMesh mesh(piece, measure);
    LocalIndex worst = 0;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      if (mesh.quality(t) < mesh.quality(worst)) worst = t;
    }
    EdgeRemoval removal;
    SmallPolyhedron polyhedron;
    CavityReplacement by_edge, cavity;
    ASSERT_TRUE(removal.propose(mesh, worst, 0, -1, by_edge));
    ASSERT_TRUE(polyhedron.propose(mesh, worst, -1, cavity)) << count;
    EXPECT_NEAR(cavity.after, by_edge.after, 1e-12) << count;
    EXPECT_EQ(cavity.old_tets.size(), static_cast<std::size_t>(count));
    std::vector<LocalIndex> placed;
    mesh.replace(cavity, placed);
    mesh.finish();
    EXPECT_NEAR(volume(piece), before, 1e-14);
  }
}

TEST(SmallPolyhedron, FillsRandomPolyhedraExactly) {
  int found = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto self = parallel::Communicator::self();
    mesh::DistributedMesh whole = mesh::examples::distribute(self, examples::shaken_cube(3, 1, 12, seed), 1);
    mesh::Piece& piece = whole.pieces[0];
    TetMesh mesh(piece, measure);
    SmallPolyhedron polyhedron;
    CavityReplacement cavity;
    std::vector<LocalIndex> placed;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      if (!mesh.is_alive(t) || mesh.quality(t) >= measure.target()) continue;
      const double before = mesh.quality(t);
      if (!polyhedron.propose(mesh, t, before, cavity)) continue;
      EXPECT_GT(cavity.after, cavity.before);
      mesh.replace(cavity, placed);
      for (const LocalIndex tet : placed) {
        EXPECT_GT(mesh.quality(tet), cavity.after - 1e-12);
        EXPECT_TRUE(mesh.is_positive(mesh.corners(tet)));
      }
      ++found;
    }
    mesh.finish();
    examples::expect_valid(whole);
  }
  EXPECT_GT(found, 50);
}

TEST(SmallPolyhedron, LeavesWhatIsBest) {
  mesh::Piece piece =
      make_piece({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {0, 1, 2, 3, 1, 2, 3, 4});
  if (volume6(piece.point(1), piece.point(2), piece.point(3), piece.point(4)) < 0)
    std::swap(piece.cells[4], piece.cells[5]);
  TetMesh mesh(piece, measure);
  SmallPolyhedron polyhedron;
  CavityReplacement cavity;
  EXPECT_FALSE(polyhedron.propose(mesh, 0, -1, cavity));
}

}  // namespace
}  // namespace aeroloom::improve
