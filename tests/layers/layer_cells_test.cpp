/// Cells of layers before the tetrahedra: they conform for any counts of columns.
#include "mesh/data/mixing.hpp"
#include "tests/layers/layered.hpp"
#include "tests/references.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;
using parallel::Communicator;

constexpr std::int32_t ball_face = 6;

volume::surfaces::Surface ball_in_a_box() {
  return volume::surfaces::cube_with_ball(7, 5);
}

bool is_on_ball(Vec3 p) {
  return norm(p) < 1.5;
}

/// Counts from 0 to 3 by chance.
std::int32_t any_count(Vec3 p) {
  std::uint64_t state = 1;
  for (const double x : {p.x, p.y, p.z}) state = mesh::mix_in(state, std::bit_cast<std::uint64_t>(x));
  return static_cast<std::int32_t>(state >> 20 & 3);
}

WantedColumn on_ball(Vec3 p, std::int32_t count) {
  return is_on_ball(p) ? WantedColumn{normalized(p), count} : WantedColumn{};
}

void expect_valid(const Layered& layered, const mesh::DistributedMesh* surface) {
  const mesh::ValidityReport report = mesh::check_volume_mesh(layered.mesh, surface);
  for (const std::string& violation : report.violations) ADD_FAILURE() << violation;
  mesh::ValidityReport of_wall = mesh::check_surface_mesh(layered.wall);
  EXPECT_NEAR(report.volume / of_wall.volume, 1, 1e-12);
}

/// What the columns make: cells by shape.
struct CellCounts {
  std::int64_t prisms = 0, pyramids = 0, tetrahedra = 0;
};

CellCounts expected_cells(const Layered& layered) {
  CellCounts cells;
  for (std::size_t p = 0; p < layered.wall.pieces.size(); ++p) {
    const Piece& piece = layered.wall.pieces[p];
    const std::vector<std::int32_t>& counts = layered.columns.pieces[p].counts;
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      if (piece.triangle_patch[t] != 0) continue;
      std::array<std::int32_t, 3> of{counts[piece.cell(t)[0]], counts[piece.cell(t)[1]],
                                     counts[piece.cell(t)[2]]};
      std::sort(of.begin(), of.end());
      cells.prisms += of[0], cells.pyramids += of[1] - of[0], cells.tetrahedra += of[2] - of[1];
    }
  }
  return {layered.communicator.sum(cells.prisms), layered.communicator.sum(cells.pyramids),
          layered.communicator.sum(cells.tetrahedra)};
}

void expect_cells(const Layered& layered) {
  const CellCounts expected = expected_cells(layered);
  const mesh::MeshCounts counts = mesh::count_mesh(layered.mesh);
  EXPECT_EQ(counts.prisms, expected.prisms);
  EXPECT_EQ(counts.pyramids, expected.pyramids);
  EXPECT_EQ(counts.cells, layered.tetrahedra + expected.prisms + expected.pyramids + expected.tetrahedra);
}

TEST(LayerCells, FillWhatIsBetweenWallAndCap) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.grow(0.02, [](Vec3 p) { return on_ball(p, 4); });
  layered.fill(volume::fields::uniform(0.4), 1000);
  expect_valid(layered, &layered.wall);
  expect_cells(layered);
  EXPECT_EQ(expected_cells(layered).prisms, 20 * 25 * 4);
  EXPECT_EQ(layered.improved.changed_triangles, 0);
}

TEST(LayerCells, ConformForAnyCounts) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.grow(0.02, [](Vec3 p) { return on_ball(p, any_count(p)); });
  layered.fill(volume::fields::uniform(0.4), 100);
  expect_valid(layered, &layered.wall);
  expect_cells(layered);
  EXPECT_GT(expected_cells(layered).pyramids, 100);
  EXPECT_GT(expected_cells(layered).tetrahedra, 100);
}

TEST(LayerCells, WithoutColumnsThereAreNone) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.grow(0.02, [](Vec3) { return WantedColumn{}; });
  layered.fill(volume::fields::uniform(0.4), 100);
  expect_valid(layered, &layered.wall);
  for (const Piece& piece : layered.mesh.pieces) EXPECT_TRUE(piece.layers.empty());
}

TEST(LayerCells, TellTheirLayerAndComeInPiecesOfTheSizeAskedFor) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.grow(0.02, [](Vec3 p) { return on_ball(p, 4); });
  constexpr std::int64_t most = 50;
  layered.fill(volume::fields::uniform(0.4), most);
  std::int64_t pieces = 0, by_layer[5] = {};
  for (const Piece& piece : layered.mesh.pieces) {
    if (piece.layers.empty()) continue;
    ++pieces;
    EXPECT_LE(piece.total_cell_count(), most);
    EXPECT_EQ(static_cast<LocalIndex>(piece.layers.size()), piece.total_cell_count());
    for (const std::int16_t layer : piece.layers) ++by_layer[layer];
  }
  EXPECT_GE(world.sum(pieces), 20 * 25 * 4 / most);
  EXPECT_EQ(world.sum(by_layer[0]), 0);
  for (int k = 1; k <= 4; ++k) EXPECT_EQ(world.sum(by_layer[k]), 20 * 25);
}

TEST(LayerCells, VerticesOffTheWallLieInTheirRegionOthersWhereTheCadHasThem) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.grow(0.02, [](Vec3 p) { return on_ball(p, 2); });
  layered.fill(volume::fields::uniform(0.4), 1000);
  std::int64_t on_ball_face = 0;
  for (const Piece& piece : layered.mesh.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const double r = norm(piece.point(v));
      const bool on_box =
          std::max({std::abs(piece.point(v).x), std::abs(piece.point(v).y), std::abs(piece.point(v).z)}) == 2;
      const bool on_wall = std::abs(r - 1) < 1e-12;
      EXPECT_EQ(is_on_boundary(piece.vertex_dimension[v]), on_box || on_wall) << r;
      if (!on_box) {
        EXPECT_EQ(piece.vertex_entity[v], on_wall ? ball_face : 0);
      }
      on_ball_face += on_wall;
    }
  }
  EXPECT_GT(world.sum(on_ball_face), 250);
}

class LayerCellsOf : public testing::TestWithParam<LayerElements> {};
INSTANTIATE_TEST_SUITE_P(Elements, LayerCellsOf, testing::Values(LayerElements::prisms, LayerElements::tets));

TEST_P(LayerCellsOf, AnyElementsAreTheSameOnAnyNumberOfRanks) {
  const auto world = Communicator::world();
  const auto make = [](const Communicator& ranks) {
    Layered layered(ranks, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
    layered.elements = GetParam();
    layered.grow(0.02, [](Vec3 p) { return on_ball(p, any_count(p)); });
    volume::VolumeOptions options;
    options.piece_tets = 1000;
    layered.fill(volume::fields::uniform(0.4), 200, options);
    return layered.hash();
  };
  const std::string here = make(world);
  if (!world.is_root()) return;
  EXPECT_EQ(here, references::of_one_rank(world, here, [&] { return make(Communicator::self()); }));
}

// --- layers that end on planes

constexpr std::int32_t floor_face = 4;

/// A cube with layers on its floor, columns up to its four sides, whose triangles the cap moves within
/// their planes.
Layered on_the_floor(const Communicator& ranks, const std::function<std::int32_t(Vec3)>& count,
                     LayerElements elements = LayerElements::prisms) {
  Layered layered(ranks, volume::surfaces::cube({0, 0, 0}, 1, 6), floor_face, mesh::PatchType::symmetry);
  layered.elements = elements;
  layered.grow(0.02, [&](Vec3 p) { return p.z == -1 ? WantedColumn{{0, 0, 1}, count(p)} : WantedColumn{}; });
  layered.fill(volume::fields::uniform(0.3), 1000);
  return layered;
}

TEST(LayerCells, EndOnPlanesInTheirQuadrilaterals) {
  const auto world = Communicator::world();
  const Layered layered = on_the_floor(world, [](Vec3) { return 3; });
  expect_valid(layered, nullptr);
  expect_cells(layered);
  const mesh::MeshCounts counts = mesh::count_mesh(layered.mesh);
  EXPECT_EQ(counts.boundary_quads, 4 * 6 * 3);
  EXPECT_EQ(counts.boundary_triangles, 6 * 6 * 6 * 2);
  for (const Piece& piece : layered.mesh.pieces) {
    for (std::size_t q = 0; q < piece.quad_face.size(); ++q) {
      EXPECT_LT(piece.quad_face[q], floor_face);
      EXPECT_EQ(piece.quad_patch[q], 1);
    }
  }
}

TEST(LayerCells, EndOnPlanesForAnyCounts) {
  const auto world = Communicator::world();
  const Layered layered = on_the_floor(world, any_count);
  expect_valid(layered, nullptr);
  expect_cells(layered);
  const mesh::MeshCounts counts = mesh::count_mesh(layered.mesh);
  for (const Piece& piece : layered.mesh.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      const bool on_cube = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) == 1;
      EXPECT_EQ(is_on_boundary(piece.vertex_dimension[v]), on_cube) << p.x << " " << p.y << " " << p.z;
    }
  }
  EXPECT_GT(counts.boundary_quads, 4);
  EXPECT_GT(counts.boundary_triangles, 6 * 6 * 6 * 2);
}

// --- layers cut into tetrahedra

/// Tetrahedra that columns make: each live one makes one in each triangle.
std::int64_t expected_tetrahedra(const Layered& layered) {
  const CellCounts cells = expected_cells(layered);
  return 3 * cells.prisms + 2 * cells.pyramids + cells.tetrahedra;
}

void expect_tetrahedra_alone(const Layered& layered) {
  const mesh::MeshCounts counts = mesh::count_mesh(layered.mesh);
  EXPECT_EQ(counts.prisms + counts.pyramids + counts.boundary_quads, 0);
  EXPECT_EQ(counts.cells, layered.tetrahedra + expected_tetrahedra(layered));
}

TEST(LayerTetrahedra, ConformForAnyCounts) {
  const auto world = Communicator::world();
  Layered layered(world, ball_in_a_box(), ball_face, mesh::PatchType::farfield);
  layered.elements = LayerElements::tets;
  layered.grow(0.02, [](Vec3 p) { return on_ball(p, any_count(p)); });
  constexpr std::int64_t most = 100;
  layered.fill(volume::fields::uniform(0.4), most);
  expect_valid(layered, &layered.wall);
  expect_tetrahedra_alone(layered);
  std::int64_t of_layers = 0;
  for (const Piece& piece : layered.mesh.pieces) {
    if (piece.layers.empty()) continue;
    EXPECT_LE(piece.total_cell_count(), most);
    of_layers += piece.total_cell_count();
  }
  EXPECT_EQ(world.sum(of_layers), expected_tetrahedra(layered));
}

TEST(LayerTetrahedra, EndOnPlanesInTriangles) {
  const auto world = Communicator::world();
  const Layered full = on_the_floor(
      world, [](Vec3) { return 3; }, LayerElements::tets);
  expect_valid(full, nullptr);
  expect_tetrahedra_alone(full);
  const mesh::MeshCounts counts = mesh::count_mesh(full.mesh);
  EXPECT_EQ(counts.boundary_triangles, 6 * 6 * 6 * 2 + 4 * 6 * 3 * 2);
  const Layered stepped = on_the_floor(world, any_count, LayerElements::tets);
  expect_valid(stepped, nullptr);
  expect_tetrahedra_alone(stepped);
}

}  // namespace
}  // namespace aeroloom::layers
