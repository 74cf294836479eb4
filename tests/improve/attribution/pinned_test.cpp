#include "parallel/communication/environment.hpp"
#include "tests/improve/attribution/strips.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::attribution {
namespace {

/// Tetrahedra around the z axis that together fill a wedge of `angle` degrees between the faces 0 and 1, one
/// piece for each; the other sides belong to face 2.
DistributedMesh make_wedge(const parallel::Communicator& communicator, double angle, int tets,
                           CadDimension on_axis) {
  DistributedMesh mesh(communicator);
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
    piece.vertex_dimension = {on_axis, on_axis, CadDimension::face, CadDimension::face};
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
    piece.shared_keys = {0, 1, mesh::SharedVertexKey(2 + i), mesh::SharedVertexKey(3 + i)};
    mesh.pieces.push_back(piece);
  }
  return mesh;
}

/// One tetrahedron with a long side of face 0 on curve 1 from CAD vertex 5, and a short side from there to a
/// vertex on curve 2. Face 2 beyond the short side, if any, makes it a part of curve 2.
DistributedMesh make_corner(const parallel::Communicator& communicator, bool ends_there) {
  DistributedMesh mesh(communicator);
  mesh.piece_count = 1;
  mesh.patches = mesh.faces = {"strip", "below", "end"};
  if (!communicator.is_root()) return mesh;
  Piece piece;
  piece.coordinates = {0, 0, 0, 1, 0, 0, 0, 0.1, 0, 0.2, 0.1, 1};
  piece.vertex_dimension = {CadDimension::vertex, CadDimension::edge, CadDimension::edge, CadDimension::face};
  piece.vertex_entity = {5, 1, 2, 1};
  piece.cells = {0, 1, 2, 3};
  add_triangle(piece, {0, 2, 1}, 0);
  add_triangle(piece, {0, 1, 3}, 1);
  if (ends_there) add_triangle(piece, {0, 3, 2}, 2);
  mesh.pieces.push_back(piece);
  return mesh;
}

/// Plane walls 0 and 1 that meet at the y axis, curve 1, at `angle` degrees, with the tetrahedron that fills
/// the first row there, where there is one, and one further off on piece 1: its lower side lies on face 0,
/// its upper vertex on face `upper` in the height of face 1 times `part`.
DistributedMesh make_walls(const parallel::Communicator& communicator, double angle, bool with_curve,
                           double part, std::int32_t upper) {
  const double slope = std::tan(angle * std::numbers::pi / 180);
  DistributedMesh mesh(communicator);
  mesh.piece_count = 2;
  mesh.patches = mesh.faces = {"lower", "upper"};
  for (int i = 0; i < 2; ++i) {
    if (i % communicator.size() != communicator.rank()) continue;
    Piece piece;
    piece.id = i;
    if (i == 0 && with_curve) {
      piece.coordinates = {0, 0, 0, 0, 1, 0, 1, 0.5, 0, 1, 0.5, slope};
      piece.vertex_dimension = {CadDimension::edge, CadDimension::edge, CadDimension::face,
                                CadDimension::face};
      piece.vertex_entity = {1, 1, 0, 1};
      piece.cells = {0, 2, 1, 3};
      add_triangle(piece, {0, 1, 2}, 0);
      add_triangle(piece, {0, 3, 1}, 1);
    } else if (i == 1) {
      piece.coordinates = {1.6, 0, 0, 2.4, 0.5, 0, 1.6, 1, 0, 1.9, 0.5, 1.9 * slope * part};
      piece.vertex_dimension = {CadDimension::face, CadDimension::face, CadDimension::face,
                                CadDimension::face};
      piece.vertex_entity = {0, 0, 0, upper};
      piece.cells = {0, 1, 2, 3};
      add_triangle(piece, {0, 2, 1}, 0);
    }
    mesh.pieces.push_back(piece);
  }
  return mesh;
}

/// A prism of layer 1 on piece 0, and on piece 1 a flat tetrahedron whose corners are the prism's three at
/// the top, or two of them and one above, and another above.
DistributedMesh make_flat_on_layers(const parallel::Communicator& communicator, int corners_on_layers) {
  DistributedMesh mesh(communicator);
  mesh.piece_count = 2;
  mesh.patches = mesh.faces = {"wall"};
  for (int i = 0; i < 2; ++i) {
    if (i % communicator.size() != communicator.rank()) continue;
    Piece piece;
    piece.id = i;
    if (i == 0) {
      piece.coordinates = {0, 0, -1, 1, 0, -1, 0, 1, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
      piece.vertex_dimension = {CadDimension::face,   CadDimension::face,   CadDimension::face,
                                CadDimension::region, CadDimension::region, CadDimension::region};
      piece.prisms = {0, 1, 2, 3, 4, 5};
      piece.layers = {1};
      add_triangle(piece, {0, 2, 1}, 0);
    } else {
      piece.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.3, 0.3, 0.05};
      piece.vertex_dimension.assign(4, CadDimension::region);
      piece.cells = {0, 1, 2, 3};
    }
    piece.vertex_entity.assign(piece.vertex_dimension.size(), 0);
    for (int k = 0; k < corners_on_layers; ++k) {
      piece.shared_vertices.push_back(i == 0 ? 3 + k : k);
      piece.shared_keys.push_back(10 + k);
    }
    mesh.pieces.push_back(piece);
  }
  return mesh;
}

PinnedReport find_in_wedge(double angle, int tets, CadDimension on_axis, double target) {
  return find(make_wedge(parallel::Communicator::world(), angle, tets, on_axis), target);
}

TEST(Pinned, FindsTheFacesThatForceAnAngle) {
  const PinnedReport report = find_in_wedge(12, 3, CadDimension::edge, 15);
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
  const PinnedReport roomy = find_in_wedge(24, 4, CadDimension::edge, 15);
  EXPECT_TRUE(roomy.entities.empty());
  EXPECT_EQ(roomy.others, 4);
  EXPECT_NEAR(roomy.smallest_angle, 6, 1e-6);
  // No curve there.
  const PinnedReport smooth = find_in_wedge(12, 3, CadDimension::face, 15);
  EXPECT_TRUE(smooth.entities.empty());
  EXPECT_EQ(smooth.others, 3);
}

TEST(Pinned, TellsFeaturesFinerThanTheElements) {
  const auto world = parallel::Communicator::world();
  const PinnedReport report = find(make_strip(world, 0.1, 4, 2), 28);
  EXPECT_TRUE(report.entities.empty());
  ASSERT_EQ(report.features.size(), 1u);
  const UnresolvedFeature& feature = report.features[0];
  EXPECT_EQ(feature.face, 0);
  EXPECT_NEAR(feature.width, 0.1, 1e-12);
  EXPECT_NEAR(feature.at.y, 0.05, 1e-12);
  EXPECT_EQ(feature.tetrahedra, 8);
  EXPECT_EQ(report.at_features.tetrahedra, 8);
  EXPECT_EQ(report.at_features.smallest_angle, feature.smallest_dihedral);
  EXPECT_LT(feature.smallest_dihedral, 15);
  EXPECT_EQ(report.rest.tetrahedra, 0);
  EXPECT_EQ(report.rest.smallest_angle, 28);
  // They are not pinned, and the gate looks at them.
  EXPECT_EQ(report.others, 8);
  EXPECT_EQ(report.smallest_angle, feature.smallest_dihedral);
}

// Flat tetrahedra in the open: one has a corner of a strip, another has none.
TEST(Pinned, TellsWhatIsBesideFeatures) {
  const auto world = parallel::Communicator::world();
  mesh::DistributedMesh mesh = make_strip(world, 0.1, 4, 2);
  mesh.piece_count += 2;
  for (int i = 0; i < 2; ++i) {
    if ((4 + i) % world.size() != world.rank()) continue;
    Piece piece;
    piece.id = 4 + i;
    const double x = i == 0 ? 0 : -5;
    piece.coordinates = {x, 0, 0, x - 1, 0.8, 0, x - 1, -0.8, 0, x - 0.6, 0, 0.05};
    piece.vertex_dimension = {i == 0 ? CadDimension::edge : CadDimension::region, CadDimension::region,
                              CadDimension::region, CadDimension::region};
    piece.vertex_entity = {i == 0 ? 1 : 0, 0, 0, 0};
    piece.cells = {0, 1, 2, 3};
    if (i == 0) piece.shared_vertices = {0}, piece.shared_keys = {0};
    mesh.pieces.push_back(piece);
  }
  const PinnedReport report = find(mesh, 28);
  EXPECT_EQ(report.at_features.tetrahedra, 8);
  EXPECT_EQ(report.beside.tetrahedra, 1);
  EXPECT_EQ(report.rest.tetrahedra, 1);
  EXPECT_EQ(report.others, 10);
}

TEST(Pinned, DoesNotExcuseTrianglesBetweenVerticesOfOneCurve) {
  const PinnedReport report = find(make_strip(parallel::Communicator::world(), 0.1, 4, 1), 28);
  EXPECT_TRUE(report.features.empty());
  EXPECT_EQ(report.rest.tetrahedra, 8);
  EXPECT_LT(report.rest.smallest_angle, 15);
}

TEST(Pinned, TellsWhatASurfaceHoldsThatMayNotChange) {
  const auto world = parallel::Communicator::world();
  const PinnedReport report = find(make_strip(world, 0.1, 4, 1), 28, false);
  EXPECT_EQ(report.held.tetrahedra, 8);
  EXPECT_LT(report.held.smallest_angle, 15);
  EXPECT_EQ(report.rest.tetrahedra, 0);
  EXPECT_EQ(report.others, 8);
  EXPECT_EQ(report.smallest_angle, report.held.smallest_angle);
  // What the CAD explains stays explained by it.
  EXPECT_EQ(find(make_strip(world, 0.1, 4, 2), 28, false).at_features.tetrahedra, 8);
  EXPECT_EQ(find(make_walls(world, 4, true, 1, 1), 28, false).pinned.tetrahedra, 2);
}

TEST(Pinned, TellsWhatLayersHold) {
  const auto world = parallel::Communicator::world();
  const PinnedReport report = find(make_flat_on_layers(world, 3), 28, false);
  EXPECT_EQ(report.held.tetrahedra, 1);
  EXPECT_EQ(report.rest.tetrahedra, 0);
  EXPECT_EQ(find(make_flat_on_layers(world, 2), 28, false).rest.tetrahedra, 1);
}

TEST(Pinned, DoesNotExcuseShortSidesOnCurves) {
  const auto world = parallel::Communicator::world();
  const PinnedReport end = find(make_corner(world, true), 28);
  EXPECT_TRUE(end.features.empty());
  EXPECT_EQ(end.rest.tetrahedra, 1);
  // Another curve that passes the CAD vertex.
  const PinnedReport passing = find(make_corner(world, false), 28);
  EXPECT_EQ(passing.features.size(), 1u);
  EXPECT_EQ(passing.rest.tetrahedra, 0);
}

TEST(Pinned, TellsShortEdgesFromStrips) {
  // The short side joins two CAD vertices; the curve beyond goes on along the long side, or away from it.
  for (const bool along : {true, false}) {
    const auto world = parallel::Communicator::world();
    DistributedMesh mesh = make_corner(world, true);
    if (world.is_root()) {
      Piece& piece = mesh.pieces.front();
      piece.vertex_dimension[2] = CadDimension::vertex;
      piece.vertex_entity[2] = 6;
      // A vertex of curve 4 beyond, with triangles of faces 0 and 1 at the edge to it.
      piece.coordinates.insert(piece.coordinates.end(), {along ? 1 : -0.1, along ? 0.15 : 1.1, 0});
      piece.vertex_dimension.push_back(CadDimension::edge);
      piece.vertex_entity.push_back(4);
      add_triangle(piece, {1, 2, 4}, 0);
      add_triangle(piece, {2, 3, 4}, 1);
    }
    const PinnedReport report = find(mesh, 28);
    EXPECT_EQ(report.at_features.tetrahedra, along ? 1 : 0);
    EXPECT_EQ(report.rest.tetrahedra, along ? 0 : 1);
  }
}

TEST(Pinned, FindsWhatAWedgeForcesBehindItsFirstRow) {
  const PinnedReport report = find(make_walls(parallel::Communicator::world(), 4, true, 1, 1), 28);
  EXPECT_EQ(report.pinned.tetrahedra, 2);
  EXPECT_EQ(report.others, 0);
  ASSERT_EQ(report.entities.size(), 1u);
  EXPECT_EQ(report.entities[0].faces, (std::array<std::int32_t, 2>{0, 1}));
  EXPECT_NEAR(report.entities[0].angle, 4, 1e-9);
  EXPECT_EQ(report.entities[0].tetrahedra, 2);
}

TEST(Pinned, TellsGapsFinerThanTheElements) {
  const auto world = parallel::Communicator::world();
  const PinnedReport report = find(make_walls(world, 4, false, 1, 1), 28);
  EXPECT_EQ(report.pinned.tetrahedra + report.rest.tetrahedra, 0);
  EXPECT_EQ(report.at_features.tetrahedra, 1);
  ASSERT_EQ(report.features.size(), 1u);
  EXPECT_EQ(report.features[0].face, 0);
  EXPECT_EQ(report.features[0].opposite, 1);
  EXPECT_NEAR(report.features[0].width, 1.9 * std::tan(4 * std::numbers::pi / 180), 1e-12);
  // Much narrower than the wedge from which it is seen: a gap all the same.
  const PinnedReport slot = find(make_walls(world, 12, true, 0.2, 1), 28);
  EXPECT_EQ(slot.pinned.tetrahedra, 1);
  EXPECT_EQ(slot.at_features.tetrahedra, 1);
}

TEST(Pinned, DoesNotExcuseFlatTetrahedraThatReachAcrossNothing) {
  const auto world = parallel::Communicator::world();
  // On one wall.
  EXPECT_EQ(find(make_walls(world, 4, true, 1, 0), 28).rest.tetrahedra, 1);
  // Where the walls are as far apart as elements are long, however flat the tetrahedron is otherwise.
  DistributedMesh mesh = make_walls(world, 16, true, 1, 1);
  for (Piece& piece : mesh.pieces) {
    if (piece.id == 1) piece.coordinates[3 * 1] = 1.7, piece.coordinates[3 * 3 + 2] = 0.8;
  }
  const PinnedReport wide = find(mesh, 28);
  EXPECT_EQ(wide.rest.tetrahedra, 1);
  EXPECT_LT(wide.rest.smallest_angle, 15);
}

TEST(Pinned, ListsNothingOfAGoodMesh) {
  const PinnedReport report = find_in_wedge(60, 1, CadDimension::edge, 15);
  EXPECT_TRUE(report.entities.empty());
  EXPECT_EQ(report.tetrahedra + report.others, 0);
}

}  // namespace
}  // namespace aeroloom::attribution
