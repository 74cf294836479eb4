#include "mesh/exchange/delivery.hpp"
#include "tests/layers/checked_layers.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

void expect_same(const Shapes& shapes, int pieces, const LayerOptions& options) {
  const auto world = Communicator::world(), self = Communicator::self();
  const mesh::DistributedMesh mesh = shapes.distribute(world, pieces),
                              whole = shapes.distribute(self, pieces);
  const Layers spread = build(mesh, options), alone = build(whole, options);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const std::size_t other = mesh::position_of(whole, mesh.pieces[p].id);
    const PieceColumns &a = spread.columns.pieces[p], &b = alone.columns.pieces[other];
    EXPECT_EQ(a.directions, b.directions);
    EXPECT_EQ(a.counts, b.counts);
    EXPECT_EQ(a.growth, b.growth);
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(spread.cap.pieces[p].coordinates, alone.cap.pieces[other].coordinates);
  }
  EXPECT_EQ(spread.report.validity_rounds, alone.report.validity_rounds);
  EXPECT_EQ(spread.report.crossings, alone.report.crossings);
  for (std::size_t i = 0; i < spread.report.patches.size(); ++i) {
    const PatchLayers &a = spread.report.patches[i], &b = alone.report.patches[i];
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.full_area, b.full_area);
    EXPECT_EQ(a.limited_area, b.limited_area);
    EXPECT_EQ(a.low_first_area, b.low_first_area);
    EXPECT_EQ(a.prisms, b.prisms);
  }
}

Shapes sphere_in_a_sphere() {
  return Shapes().add_sphere({0, 0, 0}, 10, 8, Fluid::inside).add_sphere({0.1, 0, 0}, 1, 12, Fluid::outside);
}
Shapes cube_in_a_sphere() {
  return Shapes()
      .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
      .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside);
}
Shapes inside_of_a_box() {
  return Shapes().add_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, Fluid::inside);
}
/// Plates of thickness 0.5 with a slit between.
Shapes slit(double width) {
  return Shapes()
      .add_sphere({1, 1, 0.5}, 12, 8, Fluid::inside)
      .add_box({0, 0, -0.5 - width}, {2, 2, -width}, {10, 10, 3}, Fluid::outside)
      .add_box({0, 0, 0}, {2, 2, 0.5}, {10, 10, 3}, Fluid::outside);
}
Shapes two_spheres(double distance) {
  return Shapes()
      .add_sphere({0, 0, 0}, 15, 8, Fluid::inside)
      .add_sphere({-1 - distance / 2, 0, 0}, 1, 12, Fluid::outside)
      .add_sphere({1 + distance / 2, 0, 0}, 1, 12, Fluid::outside);
}
/// The inside of a wedge of 10 degrees, cut off before its edge or not: a box whose height falls along x.
Shapes inside_of_a_wedge() {
  const double slope = std::tan(5 * M_PI / 180);
  return Shapes().add_box({0, 0, -1}, {1, 1, 1}, {10, 10, 4}, Fluid::inside, [=](Vec3 p) {
    return Vec3{p.x, p.y, p.z * slope * (p.x + 0.02)};
  });
}

TEST(BuildLayers, CoverASphereInASphere) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = sphere_in_a_sphere().distribute(world, 5);
  const Layers layers = build(mesh, options_for({0, 1e-3}));
  expect_valid(mesh, layers);
  const PatchLayers& patch = layers.report.patches[1];
  EXPECT_EQ(patch.partial_area, 0);
  EXPECT_EQ(patch.low_first_area, 0);
  EXPECT_GT(patch.isotropic_area, 0.9 * patch.area);
  EXPECT_EQ(patch.triangles, 12 * 12 * 12);
  EXPECT_EQ(layers.report.patches[0].area, 0);
  EXPECT_GE(patch.most_layers, 24);
  EXPECT_NEAR(patch.sums.layers / patch.area, 26, 3);
  EXPECT_EQ(layers.report.crossings, 0);
  for (const PieceColumns& columns : layers.columns.pieces) {
    for (std::size_t v = 0; v < columns.counts.size(); ++v) {
      if (columns.counts[v] == 0) continue;
      EXPECT_NEAR(columns.first[v], 1e-3, 2e-5) << "along the normals of the triangles";
    }
  }
}

TEST(BuildLayers, CoverTheEdgesAndCornersOfACube) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube_in_a_sphere().distribute(world, 5);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  expect_valid(mesh, layers);
  const PatchLayers& patch = layers.report.patches[1];
  EXPECT_EQ(patch.empty_area, 0);
  EXPECT_GT(patch.full_area, 0.95 * patch.area);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      const auto is_end = [](double x) { return x == 0 || x == 1; };
      if (is_end(at.x) + is_end(at.y) + is_end(at.z) != 2) continue;
      EXPECT_NEAR(layers.columns.pieces[p].first[v], std::sqrt(2.0) * 1e-4, 0.1e-4) << "on an edge they lean";
    }
  }
}

// At the acute edges of a sheared cube a column leans by 81 degrees off both walls. It is lengthened to twice
// its height at most.
TEST(BuildLayers, TellWhereTheFirstLayerIsLow) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = Shapes()
                                         .add_sphere({2, 0.5, 0.5}, 20, 8, Fluid::inside)
                                         .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside,
                                                  [](Vec3 p) {
                                                    return Vec3{p.x + 3 * p.z, p.y, p.z};
                                                  })
                                         .distribute(world, 5);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  expect_valid(mesh, layers);
  const PatchLayers& patch = layers.report.patches[1];
  EXPECT_GT(patch.low_first_area, 0.01 * patch.area);
  EXPECT_LT(patch.low_first_area, 0.2 * patch.area);
}

TEST(BuildLayers, FillTheCornersOfABox) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = inside_of_a_box().distribute(world, 5);
  const Layers layers = build(mesh, options_for({1e-3}));
  expect_valid(mesh, layers);
  const PatchLayers& patch = layers.report.patches[0];
  EXPECT_EQ(patch.empty_area, 0);
  EXPECT_GT(patch.partial_area, 0) << "towards the edges";
  EXPECT_GT(patch.sums.layers, 0.6 * static_cast<double>(patch.most_layers) * patch.area);
}

TEST(BuildLayers, LeaveRoomInASlit) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = slit(0.3).distribute(world, 7);
  const Layers layers = build(mesh, options_for({0, 1e-3, 1e-3}));
  expect_valid(mesh, layers);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 from = mesh.pieces[p].point(v), to = layers.cap.pieces[p].point(v);
      const bool in_slit = from.x > 0.3 && from.x < 1.7 && from.y > 0.3 && from.y < 1.7;
      if (!in_slit || (from.z != 0 && from.z != -0.3)) continue;
      EXPECT_LT(std::abs(to.z - from.z), 0.4 * 0.3 * (1 + 1e-6));
      EXPECT_GT(layers.columns.pieces[p].counts[v], 12);
    }
  }
  EXPECT_GT(layers.report.patches[1].limited_area[static_cast<std::size_t>(LayerLimit::gap)], 1);
}

TEST(BuildLayers, EndWhereAWedgeIsTooSharp) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = inside_of_a_wedge().distribute(world, 4);
  const Layers layers = build(mesh, options_for({1e-4}));
  expect_valid(mesh, layers);
  EXPECT_LT(layers.report.patches[0].empty_area, 0.1 * layers.report.patches[0].area);
}

TEST(BuildLayers, KeepTwoSpheresApart) {
  const auto world = Communicator::world();
  for (const double distance : {0.3, 0.02}) {
    const mesh::DistributedMesh mesh = two_spheres(distance).distribute(world, 6);
    const Layers layers = build(mesh, options_for({0, 1e-3, 1e-3}));
    expect_valid(mesh, layers);
    EXPECT_EQ(layers.report.patches[1].empty_area, 0);
    EXPECT_GT(layers.report.patches[2].full_area, 0.7 * layers.report.patches[2].area);
  }
}

TEST(BuildLayers, StepDownToFacesWhereTheyMayNotEnd) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = cube_in_a_sphere().distribute(world, 5);
  mesh.patches.emplace_back("top");
  for (mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const bool top = std::all_of(piece.cell(t), piece.cell(t) + 3,
                                   [&](mesh::LocalIndex v) { return piece.point(v).z == 1; });
      if (top) piece.triangle_patch[t] = 2;
    }
  }
  const Layers layers = build(mesh, options_for({0, 1e-3, 0}));
  expect_valid(mesh, layers);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      if (mesh.pieces[p].point(v).z != 1) continue;
      EXPECT_EQ(layers.columns.pieces[p].counts[v], 0);
    }
  }
  const PatchLayers& patch = layers.report.patches[1];
  EXPECT_GT(patch.limited_area[static_cast<std::size_t>(LayerLimit::slope)], 0);
  EXPECT_GT(patch.limited_area[static_cast<std::size_t>(LayerLimit::ending)], 0);
  EXPECT_EQ(layers.report.patches[2].area, 0);
}

TEST(BuildLayers, LeaveAWallWithoutLayersAsItIs) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = sphere_in_a_sphere().distribute(world, 3);
  const Layers layers = build(mesh, {});
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    EXPECT_EQ(layers.cap.pieces[p].coordinates, mesh.pieces[p].coordinates);
    EXPECT_EQ(layers.cap.pieces[p].vertex_dimension, mesh.pieces[p].vertex_dimension);
  }
}

TEST(BuildLayers, RefuseOptionsThatDoNotFit) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = sphere_in_a_sphere().distribute(world, 3);
  const auto refused = [&](const std::function<void(LayerOptions&)>& change) {
    LayerOptions options = options_for({0, 1e-3});
    change(options);
    EXPECT_THROW(build(mesh, options), std::runtime_error);
  };
  refused([](LayerOptions& o) { o.patches.resize(3); });
  refused([](LayerOptions& o) { o.patches[1].first = -1; });
  refused([](LayerOptions& o) { o.patches[1].growth = 0.9; });
  refused([](LayerOptions& o) { o.patches[1].growth = 1; });
  refused([](LayerOptions& o) { o.patches[1].constant = 0; });
}

TEST(BuildLayers, GiveTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  expect_same(cube_in_a_sphere(), 5, options_for({0, 1e-4}));
  expect_same(slit(0.1), 7, options_for({0, 1e-3, 1e-3}));
  expect_same(inside_of_a_wedge(), 4, options_for({1e-4}));
}

// Two triangles with layers and one without, two vertices on a sharp edge, one on a smooth one.
TEST(WallLoadLocal, IsOfWhatHasLayersAndOfSharpEdges) {
  mesh::Piece piece;
  piece.triangle_patch = {0, 0, 1};
  piece.vertex_dimension = {mesh::CadDimension::edge, mesh::CadDimension::edge, mesh::CadDimension::edge,
                            mesh::CadDimension::face};
  piece.vertex_entity = {0, 0, 1, 0};
  LayerOptions options = checked::options_for({0.1, 0});
  const double without_ridges = predict_wall_load(piece, options);
  EXPECT_GT(without_ridges, 2);
  EXPECT_LT(without_ridges, 3);
  options.edges = {EdgeTurn::sharp, EdgeTurn::smooth};
  const double with_ridges = predict_wall_load(piece, options);
  EXPECT_GT(with_ridges, without_ridges + 2);
  options.fans = FanPlaces::none;
  EXPECT_EQ(predict_wall_load(piece, options), without_ridges);
  EXPECT_LT(predict_wall_load(piece, checked::options_for({0, 0})), 1);
}

}  // namespace
}  // namespace aeroloom::layers
