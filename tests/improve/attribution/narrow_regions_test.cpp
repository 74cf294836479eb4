#include "parallel/communication/environment.hpp"
#include "tests/improve/attribution/strips.hpp"

#include <gtest/gtest.h>

namespace aeroloom::attribution {
namespace {

// A strip between the strands of one curve: its long sides are on the curve, where faces 1 and 2 begin. At
// the end of the strip, and where the curve bends only, two sides of a triangle are.
TEST(NarrowRegions, AreFoundBetweenStrandsOfOneCurve) {
  const auto world = parallel::Communicator::world();
  DistributedMesh mesh = make_strip(world, 0.1, 4, 1);
  for (Piece& piece : mesh.pieces) {
    add_triangle(piece, {0, 1, 4}, 1);
    add_triangle(piece, {2, 4, 3}, 2);
  }
  const PinnedReport strip = find(mesh, 28);
  EXPECT_EQ(strip.at_features.tetrahedra, 8);
  EXPECT_EQ(strip.rest.tetrahedra, 0);
  ASSERT_EQ(strip.features.size(), 1u);
  EXPECT_NEAR(strip.features[0].width, 0.1, 1e-12);
}

TEST(NarrowRegions, TellSharpTurnsOfCurvesFromBends) {
  const auto world = parallel::Communicator::world();
  for (const bool is_sharp : {true, false}) {
    DistributedMesh mesh(world);
    mesh.piece_count = 1;
    mesh.patches = mesh.faces = {"strip", "below", "beyond"};
    if (world.is_root()) {
      // Two sides on curve 1, which meet in vertex 0: at 6 degrees, or at 164.
      Piece piece;
      piece.coordinates = {0, 0, 0, 1, is_sharp ? 0 : 0.1, 0, is_sharp ? 1.0 : -1.0, 0.1, 0, 0.3, 0.1, 1};
      piece.vertex_dimension.assign(3, CadDimension::edge);
      piece.vertex_dimension.push_back(CadDimension::face);
      piece.vertex_entity = {1, 1, 1, 1};
      piece.cells = {0, 1, 2, 3};
      add_triangle(piece, {0, 2, 1}, 0);
      add_triangle(piece, {0, 1, 3}, 1);
      add_triangle(piece, {0, 3, 2}, 2);
      mesh.pieces.push_back(piece);
    }
    const PinnedReport report = find(mesh, 28);
    EXPECT_EQ(report.at_features.tetrahedra, is_sharp ? 1 : 0);
    EXPECT_EQ(report.rest.tetrahedra, is_sharp ? 0 : 1);
  }
}

}  // namespace
}  // namespace aeroloom::attribution
