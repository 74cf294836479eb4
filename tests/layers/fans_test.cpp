/// Fans at the sharp edges of small bodies.
#include "layers/fans.hpp"

#include "mesh/data/cad_dimension.hpp"
#include "tests/layers/checked_layers.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

constexpr std::int32_t edge_number = 3;

bool is_end(double x) {
  return x == 0 || x == 1;
}
/// 2 on edges of the unit cube, 3 at its corners.
int ends(Vec3 p) {
  return is_end(p.x) + is_end(p.y) + is_end(p.z);
}

/// Makes all vertices such of the CAD, so that edges are sharp where the mesh is.
void mark_vertices(mesh::DistributedMesh& mesh) {
  for (mesh::Piece& piece : mesh.pieces)
    std::fill(piece.vertex_dimension.begin(), piece.vertex_dimension.end(), mesh::CadDimension::vertex);
}

/// A cube of edge 1 in a sphere, whose edges and corners are those of a CAD model.
mesh::DistributedMesh cube(const Communicator& communicator) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside)
                                   .distribute(communicator, 5);
  for_each_vertex(mesh, [](mesh::Piece& piece, mesh::LocalIndex v, Vec3 p) {
    const int at = ends(p);
    if (norm(p) > 3 || at < 2) return;
    piece.vertex_dimension[v] = at == 2 ? mesh::CadDimension::edge : mesh::CadDimension::vertex;
    const bool is_chosen = p.x == 0 && (p.y == 0 || p.z == 0);
    piece.vertex_entity[v] = at == 2 && is_chosen ? edge_number : 0;
  });
  return mesh;
}

TEST(Fans, CoverTheEdgesAndCornersOfACube) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube(world);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  expect_valid(mesh, layers);
  const PatchLayers& patch = layers.report.patches[1];
  EXPECT_NEAR(patch.full_area, patch.area, 1e-12);
  EXPECT_EQ(patch.low_first_area, 0);
  EXPECT_GT(patch.hexahedra, 1000);
  std::int32_t on_edges = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      const std::int32_t count = columns.columns_at(v);
      if (ends(at) == 2) {
        EXPECT_NEAR(columns.first[v], 1e-4, 1e-6) << "the outer columns stand on their walls";
        EXPECT_TRUE(on_edges == 0 || on_edges == count) << "as many on all edges";
        on_edges = count;
        EXPECT_GE(count, 4);
      } else if (ends(at) == 3) {
        EXPECT_GE(count, 3 * 3 + 1) << "those of three edges and one within at least";
      } else {
        EXPECT_EQ(count, 1);
      }
    }
  }
}

TEST(Fans, HaveEqualSectors) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube(world);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (const FanFace& face : columns.fan_faces) {
      if (!face.is_sector()) continue;
      const Vec3 along = normalized(mesh.pieces[p].point(columns.vertex_of(face.columns[3])) -
                                    mesh.pieces[p].point(columns.vertex_of(face.columns[0])));
      const auto area = [&](int a, int b) {
        return dot(along, cross(columns.directions[face.columns[a]], columns.directions[face.columns[b]]));
      };
      EXPECT_NEAR(std::abs(area(0, 1)), std::abs(area(3, 2)), 1e-12);
    }
  }
}

// Of 1/16 along y, of 1/4 along x and z. Sectors as wide as those would be four times as wide as long.
TEST(Fans, AreNotMuchWiderThanTheEdgesAlongThem) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 1}, {4, 16, 4}, Fluid::outside)
                                   .distribute(world, 5);
  mark_vertices(mesh);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  expect_valid(mesh, layers);
  const auto sectors_at = [&](Vec3 place) {
    std::int64_t sectors = 0;
    for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
      const PieceColumns& columns = layers.columns.pieces[p];
      for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
        if (mesh.pieces[p].point(v) == place) sectors = columns.columns_at(v) - 1;
      }
    }
    return world.maximum(sectors);
  };
  EXPECT_GE(sectors_at({0, 0.5, 0}), 2 * sectors_at({0.5, 0, 0}));
  EXPECT_GE(sectors_at({0.5, 0, 0}), 3);
}

TEST(Fans, AreMissingInLayersOfTetrahedra) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube(world);
  LayerOptions options = options_for({0, 1e-4});
  options.elements = LayerElements::tets;
  const Layers layers = build(mesh, options);
  expect_valid(mesh, layers);
  for (const PieceColumns& columns : layers.columns.pieces)
    EXPECT_EQ(columns.column_count(), static_cast<std::int32_t>(columns.counts.size()));
}

TEST(Fans, AreMissingOnRequest) {
  const mesh::DistributedMesh mesh = cube(Communicator::world());
  LayerOptions options = options_for({0, 1e-4});
  options.fans = FanPlaces::none;
  EXPECT_EQ(build(mesh, options).report.patches[1].hexahedra, 0);
}

// Two of the three edges at a corner are smooth, so the ridge along the third ends there.
TEST(Fans, EndWhereARidgeDoes) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = cube(world);
  LayerOptions options = options_for({0, 1e-4});
  options.edges.assign(edge_number + 1, EdgeTurn::sharp);
  options.edges[edge_number] = EdgeTurn::smooth;
  const Layers layers = build(mesh, options);
  expect_valid(mesh, layers);
  EXPECT_GT(layers.report.patches[1].hexahedra, 1000);
  EXPECT_GT(layers.report.patches[1].empty_area, 0);
}

/// Two plates with a slit between, with CAD edges; vertices are 0.1 apart along y, 0.2 along x.
mesh::DistributedMesh slit(const Communicator& communicator, double width) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({1, 1, 0.5}, 12, 8, Fluid::inside)
                                   .add_box({0, 0, -0.5 - width}, {2, 2, -width}, {10, 20, 3}, Fluid::outside)
                                   .add_box({0, 0, 0}, {2, 2, 0.5}, {10, 20, 3}, Fluid::outside)
                                   .distribute(communicator, 7);
  mark_vertices(mesh);
  return mesh;
}

/// The fewest columns on edges of the plates, in the slit or on the other side.
std::int64_t fewest_columns(const mesh::DistributedMesh& mesh, const Layers& layers, double width,
                            bool in_slit) {
  std::int64_t least = 100;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      const bool low = at.z == 0 || at.z == -width, on_edge = at.x == 0 && at.y > 0 && at.y < 2;
      if (on_edge && (low || at.z == 0.5 || at.z == -0.5 - width) && low == in_slit)
        least = std::min<std::int64_t>(least, columns.columns_at(v));
    }
  }
  return mesh.communicator.minimum(least);
}

TEST(Fans, HaveFewerSectorsWhereColumnsAreLow) {
  const mesh::DistributedMesh mesh = slit(Communicator::world(), 0.22);
  const Layers layers = build(mesh, options_for({0, 1e-3, 1e-3}));
  expect_valid(mesh, layers);
  EXPECT_LT(fewest_columns(mesh, layers, 0.22, true), fewest_columns(mesh, layers, 0.22, false));
  EXPECT_GE(fewest_columns(mesh, layers, 0.22, true), 2);
}

// The front over them would be too narrow.
TEST(Fans, AreMissingWhereColumnsAreVeryLow) {
  const mesh::DistributedMesh mesh = slit(Communicator::world(), 0.05);
  const Layers layers = build(mesh, options_for({0, 1e-3, 1e-3}));
  expect_valid(mesh, layers);
  EXPECT_EQ(fewest_columns(mesh, layers, 0.05, true), 1);
  EXPECT_GE(fewest_columns(mesh, layers, 0.05, false), 2);
}

// Its neighbours' fans would end there, and at such ends there are no layers.
TEST(Fans, GoOnOverOneVertexWhereColumnsAreLow) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0.5}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::outside)
                                   .add_box({1.03, 0.48, 1.03}, {1.07, 0.52, 1.07}, {1, 1, 1}, Fluid::outside)
                                   .distribute(world, 5);
  mark_vertices(mesh);
  const Layers layers = build(mesh, options_for({0, 1e-4, 0}));
  expect_valid(mesh, layers);
  double below = 0, beside = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      if (at.x != 1 || at.z != 1 || std::abs(at.y - 0.5) > 0.2) continue;
      EXPECT_GT(columns.columns_at(v), 1) << at.y;
      double& highest = at.y == 0.5 ? below : beside;
      highest = std::max(highest, height(columns, v, columns.counts[v]));
    }
  }
  EXPECT_GT(world.maximum(below), 0.005);
  EXPECT_LT(world.maximum(below), 0.048);  // sectors of two are 0.3 edges wide there
  EXPECT_GT(world.maximum(beside), 0.048);
}

/// A box with a nose before it, along which the CAD is smooth. The edges of its flat ends bend there by 143
/// degrees, and the nose sticks out in the middle, so that the walls beside it face the ends.
mesh::DistributedMesh nosed_box(const Communicator& communicator) {
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0, 0.5, 0.5}, 12, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {2, 1, 1}, {4, 4, 2}, Fluid::outside)
                                   .distribute(communicator, 5);
  for_each_vertex(mesh, [](mesh::Piece& piece, mesh::LocalIndex v, Vec3 p) {
    if (norm(p) > 3) return;
    const int at = is_end(p.y) + is_end(p.z) + (p.x == 0 || p.x == 2 ? 1 : 0);
    const bool is_nose = p.x == 0 && p.z == 0.5;
    if (is_nose) piece.set_point(v, {-1.5 - 1.5 * std::min(p.y, 1 - p.y), p.y, p.z});
    if (at < 2 && !is_nose) return;
    piece.vertex_dimension[v] = at == 3 ? mesh::CadDimension::vertex : mesh::CadDimension::edge;
    piece.vertex_entity[v] = is_nose && !is_end(p.y) ? edge_number : 0;
  });
  return mesh;
}

TEST(Fans, HaveFewerSectorsWhereTheirFirstLayerIsTwisted) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = nosed_box(world);
  LayerOptions options = options_for({0, 1e-4});
  options.edges.assign(edge_number + 1, EdgeTurn::sharp);
  options.edges[edge_number] = EdgeTurn::smooth;
  const Layers layers = build(mesh, options);
  expect_valid(mesh, layers);
  std::int64_t fans = 0, empty = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      if (columns.columns_at(v) == 1) continue;
      ++fans;
      empty += columns.counts[v] == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(world.sum(fans), 20);
  EXPECT_EQ(world.sum(empty), 0);
}

// Between upright columns the front over it would be as narrow as the plate.
TEST(Fans, LeanApartOverStrips) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = Shapes()
                                   .add_sphere({0.5, 0.5, 0}, 10, 8, Fluid::inside)
                                   .add_box({0, 0, 0}, {1, 1, 0.02}, {8, 8, 1}, Fluid::outside)
                                   .distribute(world, 5);
  mark_vertices(mesh);
  const Layers layers = build(mesh, options_for({0, 1e-4}));
  expect_valid(mesh, layers);
  EXPECT_GT(layers.report.patches[1].hexahedra, 1000);
  std::int64_t seen = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      if (at.x != 1 || at.z == 0 || ends(at) > 1) continue;
      double outermost = 0;
      for (std::int32_t c = columns.first_column[v]; c < columns.first_column[v + 1]; ++c)
        outermost = std::max(outermost, columns.directions[c].x);
      EXPECT_NEAR(outermost, std::cos(20 * std::numbers::pi / 180), 1e-3);
      ++seen;
    }
  }
  EXPECT_GT(world.sum(seen), 0);
}

TEST(Fans, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash = [](const mesh::DistributedMesh& mesh, const LayerOptions& options) {
    return mesh::hash_mesh(mesh::number_mesh(build(mesh, options).cap));
  };
  const auto world = Communicator::world(), self = Communicator::self();
  EXPECT_EQ(hash(cube(world), options_for({0, 1e-4})), hash(cube(self), options_for({0, 1e-4})));
  EXPECT_EQ(hash(slit(world, 0.1), options_for({0, 1e-3, 1e-3})),
            hash(slit(self, 0.1), options_for({0, 1e-3, 1e-3})));
}

}  // namespace
}  // namespace aeroloom::layers
