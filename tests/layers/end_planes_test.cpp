#include "layers/end_planes.hpp"

#include "mesh/checks/intersection.hpp"
#include "mesh/exchange/delivery.hpp"
#include "tests/meshes/wall_meshes.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;

constexpr int floor_face = 0, x_face = 1, y_face = 2, lid_face = 3;

/// The inside of a box that lies askew or not: its floor, two sides, and a lid with the other sides.
Shapes box_with_planes(const std::function<Vec3(Vec3)>& place = [](Vec3 p) { return p; }) {
  return Shapes()
      .add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::inside)
      .label([](Vec3 middle) {
        return middle.z == 0 ? floor_face : middle.x == 0 ? x_face : middle.y == 0 ? y_face : lid_face;
      })
      .move(place);
}

mesh::DistributedMesh distribute(const Communicator& communicator, const Shapes& shapes) {
  mesh::DistributedMesh mesh = shapes.distribute_faces(communicator, 2);
  mesh.patch_types = {mesh::PatchType::wall, mesh::PatchType::symmetry, mesh::PatchType::outlet,
                      mesh::PatchType::farfield};
  return mesh;
}

LayerOptions layers_on_floor() {
  LayerOptions options;
  options.patches.resize(1);
  options.patches[0].first = 1e-3;
  options.ends_on_planes = true;
  return options;
}

/// Does not mesh planes again: takes their triangles away, so that nobody minds them.
std::vector<mesh::SharedVertexKey> take_planes_away(const mesh::DistributedMesh&,
                                                    mesh::DistributedMesh& cap) {
  for (mesh::Piece& piece : cap.pieces) {
    if (piece.common_face() != x_face && piece.common_face() != y_face) continue;
    piece.cells.clear(), piece.triangle_face.clear(), piece.triangle_patch.clear();
  }
  // The pieces of the lid come after those of planes here: they move up.
  std::vector<mesh::Piece> kept, planes;
  for (mesh::Piece& piece : cap.pieces) (piece.cells.empty() ? planes : kept).push_back(std::move(piece));
  for (mesh::Piece& piece : kept) piece.id -= piece.common_face() == lid_face ? 4 : 0;
  for (mesh::Piece& piece : planes) piece.id += 2;
  kept.insert(kept.end(), planes.begin(), planes.end());
  cap.pieces = std::move(kept);
  return {};
}

Layers build(const mesh::DistributedMesh& mesh, const LayerOptions& options, const PlaneRemesher& remesh) {
  const mesh::NumberedMesh wall{mesh::number_mesh(mesh)};
  return build_layers(wall, options, remesh);
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(EndPlanes, AreThePlanarFacesOfTheirTypes) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes());
  EXPECT_EQ(find_end_planes(mesh, layers_on_floor()), (std::vector<Vec3>{{}, {-1, 0, 0}, {0, -1, 0}, {}}));
  EXPECT_EQ(find_end_planes(mesh, {}), std::vector<Vec3>(4)) << "unless options say so";
  LayerOptions options = layers_on_floor();
  options.patches.resize(2);
  options.patches[1].first = 1e-3;
  EXPECT_EQ(find_end_planes(mesh, options)[x_face], Vec3{}) << "it has layers itself";
}

TEST(EndPlanes, AreNotCurved) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes([](Vec3 p) {
                                                  return Vec3{p.x - 0.1 * (1 - p.x) * p.z * p.z, p.y, p.z};
                                                }));
  const std::vector<Vec3> planes = find_end_planes(mesh, layers_on_floor());
  EXPECT_EQ(planes[x_face], Vec3{});
  EXPECT_EQ(planes[y_face], (Vec3{0, -1, 0}));
}

TEST(EndPlanes, MayLieAskew) {
  const auto world = Communicator::world();
  const auto turned = [](Vec3 p) { return Vec3{0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y, p.z}; };
  const std::vector<Vec3> planes =
      find_end_planes(distribute(world, box_with_planes(turned)), layers_on_floor());
  EXPECT_NEAR(distance(planes[x_face], {-0.8, -0.6, 0}), 0, 1e-14);
  EXPECT_NEAR(distance(planes[y_face], {0.6, -0.8, 0}), 0, 1e-14);
}

TEST(AlongPlanesLocal, LeavesAllBitsOfACoordinate) {
  const std::vector<Vec3> planes{{0, -1, 0}, {0.6, 0, 0.8}};
  const Vec3 one = along_planes({0.3, 0.2, 0.5}, std::span(planes).first(1));
  EXPECT_EQ(one, (Vec3{0.3, 0, 0.5}));
  for (const double y : {0.0, -0.0, 1.0 / 3}) EXPECT_TRUE(same_bits(y + 12.3 * one.y, y));
  const Vec3 both = along_planes({0.3, 0.2, 0.5}, planes);
  EXPECT_EQ(both.y, 0);
  EXPECT_NEAR(dot(both, planes[1]), 0, 1e-15);
}

TEST(EndPlanes, HoldTheEndsOfLayers) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes());
  const Layers layers = build(mesh, layers_on_floor(), take_planes_away);
  std::int64_t on_planes = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 from = piece.point(v);
      if (from.z != 0) {
        EXPECT_EQ(columns.counts[v], 0);
        continue;
      }
      EXPECT_EQ(columns.counts[v] == 0, from.x == 1 || from.y == 1) << "the far field ends them at zero";
      if (columns.counts[v] == 0) continue;
      const Vec3 to = node(piece, columns, columns.first_column[v], columns.counts[v]);
      EXPECT_GT(to.z, 0);
      EXPECT_TRUE(from.x != 0 || same_bits(to.x, from.x));
      EXPECT_TRUE(from.y != 0 || same_bits(to.y, from.y));
      on_planes += from.x == 0 || from.y == 0;
      if (from.x == 0 && from.y == 0) {
        EXPECT_EQ(columns.directions[columns.first_column[v]], (Vec3{0, 0, 1}));
        EXPECT_GE(columns.counts[v], 20) << "as many as elsewhere: planes are not in the way";
      }
    }
  }
  EXPECT_GE(world.sum(on_planes), 15);
}

/// Remeshes planes unless vertices at x = 0 have moved to where they may not be.
PlaneRemesher refuse_moves(const mesh::DistributedMesh& wall,
                           std::function<bool(Vec3 from, Vec3 to)> is_refused) {
  const Communicator& world = wall.communicator;
  return [&world, &wall, is_refused = std::move(is_refused)](const mesh::DistributedMesh& before,
                                                             mesh::DistributedMesh& cap) {
    std::vector<mesh::SharedVertexKey> at_fault;
    for (std::size_t p = 0; p < cap.pieces.size(); ++p) {
      for (std::size_t s = 0; s < cap.pieces[p].shared_keys.size(); ++s) {
        const mesh::LocalIndex v = cap.pieces[p].shared_vertices[s];
        const Vec3 from = wall.pieces[p].point(v), to = cap.pieces[p].point(v);
        if (from.x == 0 && is_refused(from, to)) at_fault.push_back(cap.pieces[p].shared_keys[s]);
      }
    }
    at_fault = world.all_gather_items(std::span<const mesh::SharedVertexKey>(at_fault));
    return at_fault.empty() ? take_planes_away(before, cap) : at_fault;
  };
}

TEST(EndPlanes, MakeColumnsShrinkWhereTheyCannotBeMeshedAgain) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes());
  // A plane that bears no trace above 0.05.
  const PlaneRemesher refuse = refuse_moves(mesh, [](Vec3 from, Vec3 to) { return to.z - from.z > 0.05; });
  const Layers layers = build(mesh, layers_on_floor(), refuse);
  double highest = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const double total = height(layers.columns.pieces[p], v, layers.columns.pieces[p].counts[v]);
      EXPECT_TRUE(mesh.pieces[p].point(v).x != 0 || total <= 0.05);
      highest = std::max(highest, total);
    }
  }
  EXPECT_GT(world.maximum(highest), 0.06) << "elsewhere they stay";
  EXPECT_GE(layers.report.crossing_rounds, 1);
}

TEST(EndPlanes, AreNotInTheWayOfColumnsBesideThem) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes([](Vec3 p) {
                                                  return Vec3{p.x, p.y, 3 * p.z};
                                                }));
  const Layers layers = build(mesh, layers_on_floor(), take_planes_away);
  std::int64_t beside = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      if (at.z != 0 || at.x > 0.25 || at.y > 0.25) continue;
      EXPECT_GT(layers.columns.pieces[p].counts[v], 15) << "hardly lower";
      ++beside;
    }
  }
  EXPECT_GE(world.sum(beside), 9);
}

TEST(EndPlanes, EmptyColumnsAtLastWhereTheyBearNoTrace) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = distribute(world, box_with_planes());
  const PlaneRemesher refuse = refuse_moves(mesh, [](Vec3 from, Vec3 to) { return !(to == from); });
  LayerOptions options = layers_on_floor();
  options.patches[0].growth = 1.005;
  const Layers layers = build(mesh, options, refuse);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v)
      EXPECT_TRUE(mesh.pieces[p].point(v).x != 0 || layers.columns.pieces[p].counts[v] == 0);
  }
  EXPECT_GT(layers.report.crossing_rounds, 10);
  EXPECT_GT(layers.report.zeroed_by_force, 0);
}

TEST(EndPlanes, NeedSomebodyWhoMeshesThemAgain) {
  const auto world = Communicator::world();
  EXPECT_THROW(build(distribute(world, box_with_planes()), layers_on_floor(), {}), std::runtime_error);
}

}  // namespace
}  // namespace aeroloom::layers
