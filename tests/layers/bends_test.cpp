/// Columns that bend over rows of stretched triangles.
#include "layers/bends.hpp"

#include "layers/column_heights.hpp"
#include "mesh/data/cad_dimension.hpp"
#include "tests/layers/checked_layers.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

/// A plate 2 long, 4 wide and 0.5 thick, of triangles 0.25 long along the edge x = 2 and down to 0.02 across.
mesh::DistributedMesh plate(const Communicator& communicator) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({1, 2, 0.25}, 20, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {2, 4, 0.5}, {20, 16, 3}, Fluid::outside)
                                   .distribute(communicator, 5);
  for_each_vertex(mesh, [](mesh::Piece& piece, mesh::LocalIndex v, Vec3 p) {
    if (distance(p, {1, 2, 0.25}) > 4) return;
    piece.set_point(v, {2 - 2 * std::pow(1 - 0.5 * p.x, 1.5), p.y, p.z});
    piece.vertex_dimension[v] = mesh::CadDimension::vertex;
  });
  return mesh;
}

LayerOptions layers_on_plate(bool bends) {
  LayerOptions options = options_for({0, 1e-3});
  options.bends_columns = bends;
  return options;
}

/// Of the front over the rows on top, edges at right angles to the edge.
double narrowest_front(const mesh::DistributedMesh& mesh, const Layers& layers) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    const auto end = [&](std::int32_t c) {
      return node(piece, columns, c, columns.counts[columns.vertex_of(c)]);
    };
    for (const auto& corners : columns.corner_columns) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = corners[i], b = corners[(i + 1) % 3];
        const Vec3 from = piece.point(columns.vertex_of(a)), to = piece.point(columns.vertex_of(b));
        const bool is_inside = std::abs(from.y - 2) < 1 && from.z == 0.5 && to.z == 0.5;
        if (is_inside && from.y == to.y && std::min(from.x, to.x) > 1.8)
          narrowest = std::min(narrowest, distance(end(a), end(b)));
      }
    }
  }
  return mesh.communicator.minimum(narrowest);
}

TEST(Bends, WidenTheFrontOverRows) {
  const mesh::DistributedMesh mesh = plate(Communicator::world());
  const Layers straight = build(mesh, layers_on_plate(false)), bent = build(mesh, layers_on_plate(true));
  expect_valid(mesh, straight);
  expect_valid(mesh, bent);
  EXPECT_LT(narrowest_front(mesh, straight), 0.08);
  EXPECT_GT(narrowest_front(mesh, bent), 0.1);
}

TEST(Bends, BeginAboveAFifthOfTheHeight) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = plate(world);
  const Layers layers = build(mesh, layers_on_plate(true));
  std::int64_t bent = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    for (std::int32_t c = 0; c < columns.column_count(); ++c) {
      const mesh::LocalIndex v = columns.vertex_of(c);
      const double total = height(columns, v, columns.counts[v]);
      for (std::int32_t k = 1; k <= columns.counts[v]; ++k) {
        const double at = height(columns, v, k);
        const Vec3 straight = piece.point(v) + at * columns.directions[c];
        const double off = distance(node(piece, columns, c, k), straight);
        if (at < 0.15 * total) EXPECT_NEAR(off, 0, 1e-15);
        if (k == columns.counts[v] && off > 0.1 * total) ++bent;
      }
    }
  }
  EXPECT_GT(world.sum(bent), 50);
}

TEST(Bends, AreMissingWithoutStretchedTriangles) {
  const mesh::DistributedMesh mesh = Shapes()
                                         .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                         .add_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, Fluid::outside)
                                         .distribute(Communicator::world(), 5);
  const Layers layers = build(mesh, layers_on_plate(true));
  expect_valid(mesh, layers);
  for (const PieceColumns& columns : layers.columns.pieces) EXPECT_TRUE(columns.curved.empty());
}

TEST(Bends, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash = [](const Communicator& communicator) {
    return mesh::hash_mesh(mesh::number_mesh(build(plate(communicator), layers_on_plate(true)).cap));
  };
  EXPECT_EQ(hash(Communicator::world()), hash(Communicator::self()));
}

}  // namespace
}  // namespace aeroloom::layers
