/// The whole stage: from a surface mesh and sizes to tetrahedra that fit together.
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "tests/references.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/filled.hpp"
#include "volume/zones/zones.hpp"

#include <set>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::no_region;
using parallel::Communicator;

VolumeOptions in_zones_of(std::int64_t tets) {
  VolumeOptions options;
  options.piece_tets = tets;
  return options;
}
constexpr std::int64_t whole = 100'000'000;

// --- the mesh is the same, whatever the zones and ranks

struct Shape {
  const char* name;
  surfaces::Surface surface;
  sizing::SizeField field;
  std::int64_t few, many;  ///< wanted tetrahedra of a zone
  /// Whether all triangles are in the Delaunay mesh, which is unique then. Where TetGen has to recover some,
  /// another mesh may come of other zones.
  bool is_unique = true;

  friend void PrintTo(const Shape& shape, std::ostream* stream) { *stream << shape.name; }
};

surfaces::Surface boxes_that_touch_in_an_edge() {
  const std::array<int, 3> n{6, 6, 3};
  return surfaces::voxels(
      n, [](int i, int j, int) { return (i < 3) == (j < 3) ? 0 : no_region; },
      surfaces::onto({-1, -1, -0.5}, {1, 1, 0.5}, n));
}
surfaces::Surface boxes_that_touch_in_a_point() {
  const std::array<int, 3> n{6, 6, 6};
  return surfaces::voxels(
      n, [](int i, int j, int k) { return (i < 3) == (j < 3) && (j < 3) == (k < 3) ? 0 : no_region; },
      surfaces::onto({-1, -1, -1}, {1, 1, 1}, n));
}
surfaces::Surface regions_in_a_row() {
  const std::array<int, 3> n{12, 4, 4};
  return surfaces::voxels(
      n, [](int i, int, int) { return i / 4; }, surfaces::onto({-1.8, -0.6, -0.6}, {1.8, 0.6, 0.6}, n));
}
surfaces::Surface ball_in_a_cube() {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1.8, 9);
  surfaces::append(surface, surfaces::between(surfaces::sphere({0, 0, 0}, 1, 5), 1, 0));
  return surface;
}
surfaces::Surface gap_around_a_box() {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 8);
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 0.97, 8), surfaces::Turn::inward);
  return surface;
}
surfaces::Surface needles() {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 10);
  // Drags a point almost onto its neighbour, which leaves triangles a thousand times longer than wide.
  for (Vec3& p : surface.points) {
    if (distance(p, {0.2, 0.2, 1}) < 1e-9) p = {0.0002, 0.0001, 1};
  }
  return surface;
}
surfaces::Surface two_boxes() {
  surfaces::Surface surface = surfaces::cube({-1, 0, 0}, 0.6, 4);
  surfaces::append(surface, surfaces::cube({1, 0.2, 0.1}, 0.6, 5));
  return surface;
}
surfaces::Surface far_away() {
  surfaces::Surface surface = surfaces::cube_with_ball(8, 4);
  for (Vec3& p : surface.points) p = 1e-3 * p + Vec3{1000, -2000, 0.0005};
  return surface;
}

std::vector<Shape> all_shapes() {
  using surfaces::shaken;
  const geometry::Box far{{999.99, -2000.01, -0.01}, {1000.01, -1999.99, 0.01}};
  const surfaces::Surface plate = surfaces::box({-1, -1, 0}, {1, 1, 0.02}, {14, 14, 1});
  return {
      {"cube_with_ball", shaken(surfaces::cube_with_ball(12, 6), 0.03), fields::uniform(0.3), 6000, 900},
      {"sizes_that_grow", shaken(surfaces::cube_with_ball(10, 9), 0.03),
       fields::around_unit_sphere(0.12, 0.4), 8000, 1500},
      {"nested_regions", shaken(surfaces::nested_cubes(8), 0.03), fields::uniform(0.17), 2000, 600},
      {"ball_in_a_cube", shaken(ball_in_a_cube(), 0.03), fields::uniform(0.3), 6000, 900},
      {"regions_in_a_row", shaken(regions_in_a_row(), 0.03), fields::uniform(0.25), 600, 250},
      {"plate", shaken(plate, 0.015), fields::uniform(0.15), 600, 150},
      {"touching_edge", shaken(boxes_that_touch_in_an_edge(), 0.03), fields::uniform(0.22), 300, 120},
      {"touching_point", shaken(boxes_that_touch_in_a_point(), 0.03), fields::uniform(0.22), 250, 100},
      {"two_boxes", shaken(two_boxes(), 0.02), fields::uniform(0.2), 600, 250},
      {"far_away", far_away(), fields::uniform(0.0005, far), 2000, 500, false},
      {"regular_squares", surfaces::cube_with_ball(12, 6), fields::uniform(0.3), 6000, 900, false},
      {"gap_around_a_box", gap_around_a_box(), fields::uniform(0.25), 800, 300, false},
      {"needles", needles(), fields::uniform(0.2), 3000, 700, false},
  };
}

class SameMesh : public testing::TestWithParam<Shape> {};
class SameMeshLocal : public SameMesh {};

TEST_P(SameMeshLocal, comes_of_one_zone_few_and_many) {
  const Communicator world = Communicator::world();
  const auto& [name, surface, field, few, many, is_unique] = GetParam();
  std::vector<std::uint64_t> expected;
  std::int32_t zones = 0;
  for (const std::int64_t tets : {whole, few, many}) {
    const Filled filled(world, surface, field, in_zones_of(tets));
    expect_valid(filled, surface);
    EXPECT_GT(filled.decomposed.zones, zones) << tets;
    zones = filled.decomposed.zones;
    if (!is_unique) continue;
    EXPECT_TRUE(filled.report.retries.empty());
    EXPECT_TRUE(filled.report.disagreements.empty());
    const std::vector<std::uint64_t> cells = cells_by_coordinates(filled);
    if (tets == whole) expected = cells;
    EXPECT_TRUE(cells == expected) << "in " << zones << " zones";
  }
  EXPECT_GE(zones, 3);
}

TEST_P(SameMesh, comes_of_any_number_of_ranks) {
  const Communicator world = Communicator::world();
  const Shape& shape = GetParam();
  const auto fill_on = [&](const Communicator& ranks) {
    return Filled(ranks, shape.surface, shape.field, in_zones_of(shape.many));
  };
  const Filled filled = fill_on(world);
  const std::string hash = mesh::hash_mesh(filled.mesh);
  // The mesh and what is known of it.
  const auto facts = [](const std::string& mesh, const Filled& of) {
    return fmt::format("{} {} {} {} {}", mesh, of.decomposed.lattice_points, of.decomposed.blocks,
                       of.report.overlap, of.decomposed.imbalance);
  };
  const std::string here = facts(hash, filled);
  if (!world.is_root()) return;
  EXPECT_EQ(here, references::of_one_rank(world, here, [&] {
              const Filled same = fill_on(Communicator::self());
              return facts(mesh::hash_mesh(same.mesh), same);
            }));
}

std::string name_of(const testing::TestParamInfo<Shape>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(all, SameMesh, testing::ValuesIn(all_shapes()), name_of);
INSTANTIATE_TEST_SUITE_P(all, SameMeshLocal, testing::ValuesIn(all_shapes()), name_of);

// --- what it is like

struct Quality {
  double mean_ratio = 0;  ///< average
  double near_size = 0;   ///< part of the edges within 0.7 and 1.4 sizes, each counted once per cell
  double below_ten = 0;   ///< part of the cells with a dihedral angle below 10 degrees
};

Quality quality_of(const Filled& filled) {
  const Communicator& communicator = filled.problem.communicator;
  double ratios = 0, edges = 0, flat = 0;
  for (const mesh::Piece& piece : filled.mesh.pieces) {
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      Vec3 p[4];
      for (int k = 0; k < 4; ++k) p[k] = piece.point(piece.cell(c)[k]);
      ratios += mesh::mean_ratio(p[0], p[1], p[2], p[3]);
      flat += mesh::dihedral_range(p[0], p[1], p[2], p[3]).smallest < 10;
      for (const auto& [i, j] : mesh::tetrahedron_edges) {
        const double ratio = distance(p[i], p[j]) / filled.problem.surface.field(0.5 * (p[i] + p[j]));
        edges += (ratio > 0.7 && ratio < 1.4) / 6.0;
      }
    }
  }
  const auto cells = static_cast<double>(filled.mesh.numbering.cell_count);
  return {communicator.sum(ratios) / cells, communicator.sum(edges) / cells, communicator.sum(flat) / cells};
}

TEST(FillZones, make_good_cells_of_the_sizes_asked_for) {
  const Communicator world = Communicator::world();
  const Filled even(world, surfaces::cube_with_ball(18, 6), fields::uniform(0.22), in_zones_of(15'000));
  const Quality quality = quality_of(even);
  EXPECT_GT(quality.mean_ratio, 0.88);
  EXPECT_GT(quality.near_size, 0.90);
  EXPECT_LT(quality.below_ten, 0.005);
  const Filled graded(world, surfaces::cube_with_ball(10, 16), fields::around_unit_sphere(0.07, 0.4),
                      in_zones_of(15'000));
  const Quality other = quality_of(graded);
  EXPECT_GT(other.mean_ratio, 0.83);
  EXPECT_GT(other.near_size, 0.80);
  EXPECT_LT(other.below_ten, 0.01);
}

TEST(FillZones, expect_about_the_tetrahedra_that_come) {
  const Communicator world = Communicator::world();
  const Filled filled(world, surfaces::cube_with_ball(18, 6), fields::uniform(0.22), in_zones_of(8'000));
  const auto cells = static_cast<double>(filled.mesh.numbering.cell_count);
  EXPECT_NEAR(filled.decomposed.expected_tetrahedra / cells, 1, 0.15);
  const auto core = static_cast<double>(filled.decomposed.core_tetrahedra);
  EXPECT_NEAR(core / static_cast<double>(filled.report.core_tetrahedra), 1, 0.05);
  EXPECT_EQ(filled.decomposed.zones, wanted_zones(filled.decomposed.expected_tetrahedra - core, 8'000));
  EXPECT_LT(filled.report.load_error_90, 0.5);
  EXPECT_GT(filled.report.overlap, 1);
  EXPECT_LT(filled.decomposed.imbalance, 1.6);
}

TEST(Decompose, wants_zones_that_divide_well_among_ranks) {
  for (const ZoneIndex zones :
       {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 96, 112, 128, 1280})
    EXPECT_EQ(wanted_zones(100.0 * zones, 100), zones);
  EXPECT_EQ(wanted_zones(0, 100), 1);
  EXPECT_EQ(wanted_zones(149, 100), 1);
  EXPECT_EQ(wanted_zones(151, 100), 2);
  for (const double zones : {9.2, 10.8, 18.0, 37.0, 99.0, 1e4, 1e6})
    EXPECT_NEAR(wanted_zones(100 * zones, 100) / zones, 1, 0.125) << zones;
}

TEST(Decompose, leaves_less_than_one_and_a_half_zones_whole) {
  const Communicator world = Communicator::world();
  const Problem problem(world, surfaces::cube_with_ball(8, 4), fields::uniform(0.4));
  const auto zones = [&](double of) {
    VolumeInput input = problem.input();
    const DecompositionReport report = decompose(input).report();
    const double expected = report.expected_tetrahedra - static_cast<double>(report.core_tetrahedra);
    input.options.piece_tets = static_cast<std::int64_t>(expected / of);
    return decompose(input).report().zones;
  };
  EXPECT_EQ(zones(1.45), 1);
  EXPECT_EQ(zones(1.55), 2);
  EXPECT_EQ(zones(4.1), 4);
}

// --- labels

TEST(FillZones, keep_names_regions_and_sides) {
  const Communicator world = Communicator::world();
  const surfaces::Surface surface = surfaces::nested_cubes(8);
  const Filled filled(world, surface, fields::uniform(0.2), in_zones_of(1500));
  EXPECT_EQ(filled.mesh.kind, mesh::CellKind::tetrahedron);
  EXPECT_EQ(filled.mesh.patches, filled.problem.surface.patches);
  EXPECT_EQ(filled.mesh.faces, filled.problem.surface.faces);
  EXPECT_EQ(filled.mesh.regions, filled.problem.surface.regions);
  for (std::size_t f = 0; f < surface.sides.size(); ++f) {
    EXPECT_EQ(filled.mesh.sides_of(static_cast<std::int32_t>(f)).front, surface.sides[f].front);
    EXPECT_EQ(filled.mesh.sides_of(static_cast<std::int32_t>(f)).back, surface.sides[f].back);
  }
  const mesh::MeshCounts counts = mesh::count_mesh(filled.mesh);
  EXPECT_EQ(counts.boundary_triangles, 6 * 2 * 64);
  EXPECT_EQ(counts.inner_triangles, 6 * 2 * 16);
  // Every vertex at a place where a surface vertex is has that one's classification.
  std::set<std::array<double, 5>> known;
  struct Row {
    double row[5];

    static constexpr auto fields() { return std::tuple(&Row::row); }
  };
  const auto rows_of = [](const mesh::DistributedMesh& mesh) {
    std::vector<Row> rows;
    for (const mesh::Piece& piece : mesh.pieces) {
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const Vec3 p = piece.point(v);
        rows.push_back({{p.x, p.y, p.z, double(piece.vertex_dimension[v]), double(piece.vertex_entity[v])}});
      }
    }
    return rows;
  };
  for (const Row& r : world.all_gather_items<Row>(rows_of(filled.problem.surface)))
    known.insert({r.row[0], r.row[1], r.row[2], r.row[3], r.row[4]});
  std::int64_t on_surface = 0;
  for (const Row& r : rows_of(filled.mesh)) {
    if (r.row[3] == 3) continue;
    ++on_surface;
    EXPECT_TRUE(known.count({r.row[0], r.row[1], r.row[2], r.row[3], r.row[4]}));
  }
  EXPECT_GE(world.sum(on_surface), static_cast<std::int64_t>(surface.points.size()));
}

}  // namespace
}  // namespace aeroloom::volume
