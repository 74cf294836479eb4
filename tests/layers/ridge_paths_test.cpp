/// Fans of sharp edges that end on a wall go on along paths.
#include "layers/ridge_paths.hpp"

#include "mesh/data/cad_dimension.hpp"
#include "tests/layers/checked_layers.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cstdint>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

constexpr std::int32_t sharp_edge = 3;

bool is_on_edge(Vec3 p) {
  return p.x == 1 && p.z == 1 && p.y >= 0 && p.y <= 1;
}
bool is_sharp(Vec3 p) {
  return is_on_edge(p) && p.y > 0.2 && p.y < 0.8;
}

/// A cube of edge 1 in a sphere. The CAD is sharp along the middle of one edge alone.
mesh::DistributedMesh creased_cube(const Communicator& communicator) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside)
                                   .distribute(communicator, 5);
  for_each_vertex(mesh, [](mesh::Piece& piece, mesh::LocalIndex v, Vec3 p) {
    if (!is_sharp(p)) return;
    piece.vertex_dimension[v] = mesh::CadDimension::edge;
    piece.vertex_entity[v] = sharp_edge;
  });
  return mesh;
}

LayerOptions layers_on_cube() {
  LayerOptions options = options_for({0, 1e-4});
  options.edges.assign(sharp_edge + 1, EdgeTurn::smooth);
  options.edges[sharp_edge] = EdgeTurn::sharp;
  options.fans = FanPlaces::all;
  return options;
}

TEST(RidgePaths, LeadFromEveryEndToARidge) {
  const Communicator world = Communicator::world();
  const mesh::DistributedMesh mesh = creased_cube(world);
  const LocalWall wall(mesh, layers_on_cube());
  const VertexStars stars = gather_stars(wall);
  EXPECT_GE(world.sum(static_cast<std::int64_t>(stars.open_ends.size())), 2);
  const PathEdges paths = find_ridge_paths(wall, stars);
  ASSERT_FALSE(paths.empty());
  EXPECT_TRUE(std::is_sorted(paths.begin(), paths.end(), [](const PathEdge& a, const PathEdge& b) {
    return a.from == b.from ? precedes(a.to, b.to) : precedes(a.from, b.from);
  }));
  for (const PathEdge& edge : paths) {
    EXPECT_GT(edge.turn, 0);
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [&](const PathEdge& other) {
      return other.from == edge.to && other.to == edge.from;
    }));
  }
  const VertexStars with_paths = gather_stars(wall, paths);
  EXPECT_EQ(world.sum(with_paths.lost_ridges), 0);
}

TEST(RidgePaths, MakeFansValid) {
  const Communicator world = Communicator::world();
  const mesh::DistributedMesh mesh = creased_cube(world);
  const Layers layers = build(mesh, layers_on_cube());
  expect_valid(mesh, layers);
  EXPECT_GT(layers.report.patches[1].hexahedra, 100);
  std::int64_t on_edge = 0, beyond = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      if (columns.columns_at(v) == 1) continue;
      ++(is_sharp(mesh.pieces[p].point(v)) ? on_edge : beyond);
    }
  }
  EXPECT_GE(world.sum(on_edge), 5);
  EXPECT_GE(world.sum(beyond), 2) << "two columns and more along paths";
}

TEST(RidgePaths, AreMadeOnRequestAlone) {
  const mesh::DistributedMesh mesh = creased_cube(Communicator::world());
  LayerOptions options = layers_on_cube();
  for (const FanPlaces fans : {FanPlaces::closed, FanPlaces::none}) {
    options.fans = fans;
    EXPECT_EQ(build(mesh, options).report.patches[1].hexahedra, 0);
  }
}

TEST(RidgePaths, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash = [](const Communicator& communicator) {
    return mesh::hash_mesh(mesh::number_mesh(build(creased_cube(communicator), layers_on_cube()).cap));
  };
  EXPECT_EQ(hash(Communicator::world()), hash(Communicator::self()));
}

}  // namespace
}  // namespace aeroloom::layers
