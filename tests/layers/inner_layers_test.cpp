/// Layers on the sides of faces between regions and of baffles: both sides share the nodes in the face.
#include "layers/opened_wall.hpp"
#include "tests/layers/layered.hpp"
#include "tests/references.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;
using mesh::Piece;
using parallel::Communicator;
using volume::surfaces::Surface;

/// The patch of inner faces, and that of all others.
constexpr std::size_t inner = 0;

constexpr double plate_height = 0.1, half_plate = 0.6;

/// Of the free plate.
bool is_on_rim(Vec3 p) {
  return p.z == plate_height && std::max(std::abs(p.x), std::abs(p.y)) > half_plate - 1e-9;
}

mesh::NumberedMesh wall_of(const Communicator& ranks, const Surface& surface) {
  mesh::DistributedMesh wall = volume::surfaces::spread(ranks, surface);
  wall.patches = {"inner", "outer"};
  wall.patch_types = {mesh::PatchType::interior, mesh::PatchType::wall};
  for (Piece& piece : wall.pieces) {
    for (std::size_t t = 0; t < piece.triangle_face.size(); ++t)
      piece.triangle_patch[t] = wall.sides_of(piece.triangle_face[t]).is_inner() ? 0 : 1;
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (is_on_rim(piece.point(v))) piece.vertex_dimension[v] = mesh::CadDimension::edge;
    }
  }
  return mesh::number_mesh(std::move(wall));
}

struct InnerLayers {
  InnerLayers(const Communicator& ranks, const Surface& surface, InnerSides sides, bool outer = false,
              LayerElements elements = LayerElements::prisms)
      : wall(wall_of(ranks, surface)) {
    LayerOptions options;
    options.patches.resize(2);
    options.patches[inner] = {.first = 0.01, .growth = 1.3, .count = 5};
    if (outer) options.patches[1] = options.patches[inner];
    options.inner_sides = {sides};
    options.elements = elements;
    layers = build_layers(wall, options);
    const sizing::SizedSurface boundary{mesh::number_mesh(layers.cap), volume::fields::uniform(0.3)};
    volume::VolumeReport report;
    volume::VolumeOptions of_volume;
    of_volume.piece_tets = 2000;
    const volume::VolumeInput input{boundary, of_volume, nullptr, true};
    mesh::DistributedMesh volume = volume::fill_zones(input, volume::decompose(input), report);
    const OpenedWall* const opened = layers.opened.get();
    append_layers(opened != nullptr ? opened->mesh : wall, layers.columns, boundary, {500, elements, opened},
                  volume);
    mesh = mesh::number_mesh(std::move(volume));
  }

  double full() const {
    double area = 0, all = 0;
    for (const PatchLayers& patch : layers.report.patches) all += patch.full_area, area += patch.area;
    return all / area;
  }
  std::string hash() const { return mesh::hash_mesh(mesh); }

  mesh::NumberedMesh wall;
  Layers layers;
  mesh::NumberedMesh mesh;
};

/// The mesh is valid and has the boundary of the wall, inner faces once.
void expect_valid(const InnerLayers& made) {
  const mesh::ValidityReport report = mesh::check_volume_mesh(made.mesh, &made.wall);
  for (const std::string& violation : report.violations) ADD_FAILURE() << violation;
  EXPECT_EQ(made.mesh.faces, made.wall.faces);
  EXPECT_EQ(made.mesh.patches, made.wall.patches);
}

/// The regions of the layer cells that stand on inner faces.
std::set<mesh::RegionId> regions_of_first_layers(const InnerLayers& made) {
  std::vector<std::int64_t> found(8, 0);
  for (const Piece& piece : made.mesh.pieces) {
    if (std::count(piece.layers.begin(), piece.layers.end(), 1) > 0) found[piece.region] = 1;
  }
  made.wall.communicator.sum_each(found);
  std::set<mesh::RegionId> regions;
  for (std::size_t r = 0; r < found.size(); ++r) {
    if (found[r] > 0) regions.insert(static_cast<mesh::RegionId>(r));
  }
  return regions;
}

Surface cube_in_a_cube() {
  return volume::surfaces::nested_cubes(8);
}
/// Two boxes that share a face, which has the first numbers.
Surface two_boxes() {
  Surface surface = volume::surfaces::voxels(
      {8, 4, 4}, [](int i, int, int) { return i / 4; },
      volume::surfaces::onto({-2, -1, -1}, {2, 1, 1}, {8, 4, 4}));
  const auto shared = std::find_if(surface.sides.begin(), surface.sides.end(),
                                   [](const mesh::FaceSides& sides) { return sides.is_inner(); });
  const auto face = static_cast<std::int32_t>(shared - surface.sides.begin());
  std::swap(surface.sides[0], *shared);
  for (std::int32_t& f : surface.face) f = f == face ? 0 : f == 0 ? face : f;
  return surface;
}
/// Eight regions around a point, in a cube.
Surface eight_cubes() {
  return volume::surfaces::voxels(
      {4, 4, 4}, [](int i, int j, int k) { return i / 2 + 2 * (j / 2) + 4 * (k / 2); },
      volume::surfaces::onto({-1, -1, -1}, {1, 1, 1}, {4, 4, 4}));
}
/// The same of one region: three baffles that cross each other and end on the sides of the cube.
Surface crossing_baffles() {
  return volume::surfaces::between(eight_cubes(), 0, 0);
}
Surface with_outer_sides(Surface surface) {
  const Surface regions = eight_cubes();
  for (std::size_t f = 0; f < surface.sides.size(); ++f) {
    if (!regions.sides[f].is_inner()) surface.sides[f] = {0, mesh::no_region};
  }
  return surface;
}
/// A plate with free rims within a cube: its squares are those between the layers of a grid.
Surface free_plate() {
  Surface surface = volume::surfaces::cube({0, 0, 0}, 1, 4);
  Surface plate;
  plate.sides.push_back({0, 0});
  constexpr int n = 6;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      plate.points.push_back({(i - 3) * half_plate / 3, (j - 3) * half_plate / 3, plate_height});
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = (n + 1) * i + j, b = a + n + 1;
      plate.triangles.push_back({a, b, a + 1});
      plate.triangles.push_back({b, b + 1, a + 1});
    }
  }
  plate.face.assign(plate.triangles.size(), 0);
  volume::surfaces::append(surface, plate);
  return surface;
}

TEST(InnerLayers, StandOnTheSideThatIsAskedFor) {
  const auto world = Communicator::world();
  const std::map<InnerSides, std::set<mesh::RegionId>> expected{
      {InnerSides::front, {0}}, {InnerSides::back, {1}}, {InnerSides::both, {0, 1}}};
  for (const auto& [sides, regions] : expected) {
    const InnerLayers made(world, cube_in_a_cube(), sides);
    expect_valid(made);
    EXPECT_EQ(regions_of_first_layers(made), regions);
    EXPECT_NEAR(made.full(), 1, 1e-12);
  }
}

TEST(InnerLayers, WithoutASideThereAreNone) {
  const InnerLayers made(Communicator::world(), cube_in_a_cube(), InnerSides::none, true);
  EXPECT_EQ(made.layers.opened, nullptr);
  expect_valid(made);
  EXPECT_EQ(made.layers.report.patches[inner].area, 0);
}

TEST(InnerLayers, BothSidesShareTheNodesInTheFace) {
  const auto world = Communicator::world();
  const InnerLayers made(world, cube_in_a_cube(), InnerSides::both);
  std::map<std::array<double, 3>, std::set<mesh::GlobalIndex>> numbers;
  std::int64_t doubled = 0;
  for (std::size_t p = 0; p < made.mesh.pieces.size(); ++p) {
    const Piece& piece = made.mesh.pieces[p];
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 at = piece.point(v);
      auto& here = numbers[{at.x, at.y, at.z}];
      here.insert(made.mesh.numbering.vertices[p][v]);
      doubled += here.size() > 1 ? 1 : 0;
    }
  }
  EXPECT_EQ(world.sum(doubled), 0);
  const double area = made.layers.report.patches[inner].area;
  EXPECT_NEAR(area, 2 * 6, 1e-9) << "of both sides";
}

TEST(InnerLayers, OfOneSideMeetThoseOfWallsThere) {
  for (const InnerSides side : {InnerSides::front, InnerSides::back}) {
    const InnerLayers made(Communicator::world(), two_boxes(), side, true);
    expect_valid(made);
    const PatchLayers& of_side = made.layers.report.patches[inner];
    EXPECT_NEAR(of_side.full_area, of_side.area, 1e-9);
    EXPECT_GT(made.full(), 0.7) << "on the other side layers of walls step down to zero";
    EXPECT_LT(made.full(), 0.99);
  }
}

TEST(InnerLayers, RegionsMeetInLinesAndPoints) {
  const InnerLayers made(Communicator::world(), eight_cubes(), InnerSides::both, true);
  expect_valid(made);
  EXPECT_EQ(regions_of_first_layers(made).size(), 8u);
  EXPECT_NEAR(made.full(), 1, 1e-12);
}

TEST(InnerLayers, BafflesCrossAndEndOnWalls) {
  const InnerLayers made(Communicator::world(), with_outer_sides(crossing_baffles()), InnerSides::both, true);
  expect_valid(made);
  EXPECT_NEAR(made.full(), 1, 1e-12);
}

TEST(InnerLayers, GoAroundFreeRims) {
  for (const bool outer : {false, true}) {
    const InnerLayers made(Communicator::world(), free_plate(), InnerSides::both, outer);
    expect_valid(made);
    EXPECT_NEAR(made.full(), 1, 1e-12);
    std::int64_t over_rims = 0;
    for (const PieceColumns& columns : made.layers.columns.pieces) {
      for (const FanFace& face : columns.fan_faces) over_rims += face.is_sector() ? 1 : 0;
    }
    EXPECT_EQ(made.wall.communicator.sum(over_rims) % (4 * 6), 0);
    EXPECT_GT(made.wall.communicator.sum(over_rims), 0);
  }
}

TEST(InnerLayers, OfBafflesTheFrontIsWhereNormalsPoint) {
  for (const InnerSides sides : {InnerSides::front, InnerSides::back}) {
    const InnerLayers made(Communicator::world(), free_plate(), sides);
    expect_valid(made);
    std::int64_t above = 0, below = 0;
    for (const Piece& piece : made.mesh.pieces) {
      if (piece.layers.empty()) continue;
      for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        above += piece.point(v).z > plate_height ? 1 : 0;
        below += piece.point(v).z < plate_height ? 1 : 0;
      }
    }
    const auto& ranks = made.wall.communicator;
    EXPECT_EQ(ranks.sum(above) > 0, sides == InnerSides::front);
    EXPECT_EQ(ranks.sum(below) > 0, sides == InnerSides::back);
  }
}

struct Place {
  Surface surface;
  LayerElements elements;
};

TEST(InnerLayers, AreTheSameOnAnyNumberOfRanks) {
  const std::vector<Place> places{{cube_in_a_cube(), LayerElements::prisms},
                                  {eight_cubes(), LayerElements::tets},
                                  {with_outer_sides(crossing_baffles()), LayerElements::prisms},
                                  {free_plate(), LayerElements::prisms}};
  for (const Place& place : places) {
    references::expect_as_on_one_rank([&](const Communicator& ranks) {
      const InnerLayers made(ranks, place.surface, InnerSides::both, true, place.elements);
      expect_valid(made);
      return made.hash();
    });
  }
}

}  // namespace
}  // namespace aeroloom::layers
