/// Fans of sharp edges that end on a wall.
#include "layers/fans.hpp"
#include "mesh/data/cad_dimension.hpp"
#include "tests/layers/checked_layers.hpp"
#include "tests/several_ranks.hpp"

#include <cmath>
#include <cstdint>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

constexpr std::int32_t sharp_edge = 3;

/// From the middle of an edge.
double distance_along(Vec3 p) {
  return p.x == 1 && p.z == 1 ? std::abs(p.y - 0.5) : 1;
}

/// A cube of edge 1 in a sphere. The CAD is sharp along the middle of one edge alone; vertices are 1/8 apart.
mesh::DistributedMesh creased_cube(const Communicator& communicator, double half_length) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside)
                                   .distribute(communicator, 5);
  for_each_vertex(mesh, [&](mesh::Piece& piece, mesh::LocalIndex v, Vec3 p) {
    if (distance_along(p) > half_length) return;
    piece.vertex_dimension[v] = mesh::CadDimension::edge;
    piece.vertex_entity[v] = sharp_edge;
  });
  return mesh;
}

LayerOptions layers_on_cube() {
  LayerOptions options = options_for({0, 1e-4});
  options.edges.assign(sharp_edge + 1, EdgeTurn::smooth);
  options.edges[sharp_edge] = EdgeTurn::sharp;
  return options;
}

TEST(FanEnds, HaveNoLayers) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = creased_cube(world, 0.3);
  const Layers layers = build(mesh, layers_on_cube());
  expect_valid(mesh, layers);
  EXPECT_GT(layers.report.patches[1].hexahedra, 100);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      if (norm(at) > 3) continue;
      EXPECT_EQ(columns.columns_at(v) > 1, distance_along(at) < 0.2) << at.y;
      EXPECT_EQ(columns.counts[v] == 0, distance_along(at) == 0.25) << at.y;
    }
  }
}

TEST(FanEnds, AreNotMadeForShortEdges) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = creased_cube(world, 0.2);
  const Layers layers = build(mesh, layers_on_cube());
  expect_valid(mesh, layers);
  EXPECT_EQ(layers.report.patches[1].hexahedra, 0);
  EXPECT_EQ(layers.report.patches[1].empty_area, 0);
}

TEST(FanEnds, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash = [](const Communicator& communicator) {
    return mesh::hash_mesh(mesh::number_mesh(build(creased_cube(communicator, 0.3), layers_on_cube()).cap));
  };
  EXPECT_EQ(hash(Communicator::world()), hash(Communicator::self()));
}

}  // namespace
}  // namespace aeroloom::layers
