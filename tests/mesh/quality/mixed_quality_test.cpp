#include "mesh/quality/mixed_quality.hpp"

#include "tests/meshes/mixed_mesh.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using geometry::Vec3;
using parallel::Communicator;

double value(const CellValues& values, Measure measure) {
  return values[static_cast<std::size_t>(measure)];
}

TEST(CellMeasuresLocal, EqualEdges) {
  const double h = std::sqrt(2.0 / 3), third = std::sqrt(3.0) / 6;
  const std::array<Vec3, 4> tet = {{{0, 0, 0}, {1, 0, 0}, {0.5, 3 * third, 0}, {0.5, third, h}}};
  const CellValues of_tet = measure_cell(CellShape::tetrahedron, tet.data());
  EXPECT_NEAR(value(of_tet, Measure::smallest_dihedral), 70.528779, 1e-6);
  EXPECT_NEAR(value(of_tet, Measure::largest_dihedral), 70.528779, 1e-6);
  EXPECT_NEAR(value(of_tet, Measure::mean_ratio), 1, 1e-12);
  EXPECT_NEAR(value(of_tet, Measure::radius_ratio), 1, 1e-12);
  EXPECT_NEAR(value(of_tet, Measure::edge_ratio), 1, 1e-12);
  EXPECT_NEAR(value(of_tet, Measure::volume), std::sqrt(2.0) / 12, 1e-12);

  const std::array<Vec3, 5> pyramid = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1 / std::numbers::sqrt2}}};
  const CellValues of_pyramid = measure_cell(CellShape::pyramid, pyramid.data());
  EXPECT_NEAR(value(of_pyramid, Measure::smallest_dihedral), 54.735610, 1e-6);
  EXPECT_NEAR(value(of_pyramid, Measure::largest_dihedral), 109.471221, 1e-6);
  EXPECT_NEAR(value(of_pyramid, Measure::scaled_jacobian), 1, 1e-12);
  EXPECT_NEAR(value(of_pyramid, Measure::edge_ratio), 1, 1e-12);
  EXPECT_NEAR(value(of_pyramid, Measure::volume), std::sqrt(2.0) / 6, 1e-12);

  std::array<Vec3, 6> prism = {
      {{0, 0, 0}, {1, 0, 0}, {0.5, 3 * third, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 3 * third, 1}}};
  const CellValues of_prism = measure_cell(CellShape::prism, prism.data());
  EXPECT_NEAR(value(of_prism, Measure::smallest_dihedral), 60, 1e-9);
  EXPECT_NEAR(value(of_prism, Measure::largest_dihedral), 90, 1e-9);
  EXPECT_NEAR(value(of_prism, Measure::scaled_jacobian), 1, 1e-12);
  EXPECT_NEAR(value(of_prism, Measure::volume), std::sqrt(3.0) / 4, 1e-12);
  EXPECT_EQ(value(of_prism, Measure::mean_ratio), 0);

  const std::array<Vec3, 8> cube = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  const CellValues of_cube = measure_cell(CellShape::hexahedron, cube.data());
  EXPECT_NEAR(value(of_cube, Measure::smallest_dihedral), 90, 1e-9);
  EXPECT_NEAR(value(of_cube, Measure::largest_dihedral), 90, 1e-9);
  EXPECT_NEAR(value(of_cube, Measure::scaled_jacobian), 1, 1e-12);
  EXPECT_NEAR(value(of_cube, Measure::edge_ratio), 1, 1e-12);
  EXPECT_NEAR(value(of_cube, Measure::volume), 1, 1e-12);
}

TEST(CellMeasuresLocal, ObliqueHexahedron) {
  // A parallelepiped: upper square moved aside by its edge.
  const std::array<Vec3, 8> p = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}}};
  const CellValues values = measure_cell(CellShape::hexahedron, p.data());
  EXPECT_NEAR(value(values, Measure::smallest_dihedral), 45, 1e-9);
  EXPECT_NEAR(value(values, Measure::largest_dihedral), 135, 1e-9);
  EXPECT_NEAR(value(values, Measure::scaled_jacobian), 1 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(value(values, Measure::edge_ratio), std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(value(values, Measure::volume), 1, 1e-12);
}

TEST(CellMeasuresLocal, ThinAndFoldedCells) {
  std::array<Vec3, 6> prism = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-3}, {1, 0, 1e-3}, {0, 1, 1e-3}}};
  CellValues values = measure_cell(CellShape::prism, prism.data());
  EXPECT_NEAR(value(values, Measure::edge_ratio), 1000 * std::numbers::sqrt2, 1e-6);
  EXPECT_NEAR(value(values, Measure::smallest_dihedral), 45, 1e-9);
  EXPECT_NEAR(value(values, Measure::scaled_jacobian), std::sin(std::numbers::pi / 4) * 2 / std::sqrt(3.0),
              1e-9);
  prism[3].z = -1e-4;  // one column goes through the base
  values = measure_cell(CellShape::prism, prism.data());
  EXPECT_LT(value(values, Measure::scaled_jacobian), 0);
  EXPECT_GT(value(values, Measure::largest_dihedral), 180);
  for (int k = 3; k < 6; ++k) prism[static_cast<std::size_t>(k)].z = -1;  // inside out
  EXPECT_NEAR(value(measure_cell(CellShape::prism, prism.data()), Measure::volume), -0.5, 1e-12);
  prism.fill({});  // a point
  values = measure_cell(CellShape::prism, prism.data());
  EXPECT_EQ(value(values, Measure::edge_ratio), largest_ratio);
  EXPECT_EQ(value(values, Measure::scaled_jacobian), 0);
  prism[2].x = std::nan("");
  for (const Measure measure : all_measures)
    EXPECT_TRUE(std::isfinite(value(measure_cell(CellShape::prism, prism.data()), measure)));
}

// Flat along a wall is no flaw of a cell of layers; flat in another way is.
TEST(FlawsLocal, ShapesDoNotDependOnStretching) {
  for (const double height : {1.0, 1e-3, 1e-6}) {
    const std::array<Vec3, 4> tet = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}}};
    EXPECT_NEAR(corner_shape(CellShape::tetrahedron, tet.data()), 1, 1e-12);
    const std::array<Vec3, 6> prism = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}, {1, 0, height}, {0, 1, height}}};
    EXPECT_GT(corner_shape(CellShape::prism, prism.data()), 0.8);
    const std::array<Vec3, 4> sliver = {{{0, 0, 0}, {1, 0, height}, {1, 1, 0}, {0, 1, height}}};
    EXPECT_LT(std::abs(corner_shape(CellShape::tetrahedron, sliver.data())), 2 * height);
  }
  const std::array<Vec3, 4> point = {};
  EXPECT_LE(corner_shape(CellShape::tetrahedron, point.data()), 0);
}

TEST(FlawsLocal, SeveritiesRunFromGoodToPoor) {
  EXPECT_EQ(verdict_of(severity_of(Flaw::small_angle, 28)), Verdict::good);
  EXPECT_EQ(verdict_of(severity_of(Flaw::small_angle, 5)), Verdict::fair);
  EXPECT_EQ(verdict_of(severity_of(Flaw::small_angle, 0.0018)), Verdict::poor);
  EXPECT_EQ(verdict_of(severity_of(Flaw::bad_shape, 0.9)), Verdict::good);
  EXPECT_EQ(verdict_of(severity_of(Flaw::bad_shape, -1)), Verdict::poor);
  EXPECT_EQ(verdict_of(severity_of(Flaw::size_jump, 2)), Verdict::good);
  EXPECT_EQ(verdict_of(severity_of(Flaw::size_jump, 11120)), Verdict::poor);
  EXPECT_EQ(verdict_of(severity_of(Flaw::size_jump, largest_ratio)), Verdict::poor);
}

TEST(CellMeasuresLocal, WarpedQuadrilateralsAddUp) {
  // Two prisms on both sides of a warped quadrilateral fill what one hexahedron of six warped faces does.
  const std::array<Vec3, 8> p = {
      {{0, 0, 0}, {1, 0.1, 0}, {1.2, 1, 0.1}, {0, 1, 0}, {0, 0.1, 1}, {1, 0, 1.3}, {1, 1, 1}, {0.2, 1, 1}}};
  const std::array<Vec3, 6> a = {p[0], p[1], p[2], p[4], p[5], p[6]},
                            b = {p[0], p[2], p[3], p[4], p[6], p[7]};
  const double sum = cell_volume(CellShape::prism, a.data()) + cell_volume(CellShape::prism, b.data());
  // Moving the middle of the common quadrilateral's edges does not exist; moving all by a constant must not
  // change the sum, and the shared face must cancel whichever corner is the origin.
  const std::array<Vec3, 6> c = {p[2], p[0], p[1], p[6], p[4], p[5]},
                            d = {p[3], p[0], p[2], p[7], p[4], p[6]};
  EXPECT_NEAR(cell_volume(CellShape::prism, c.data()) + cell_volume(CellShape::prism, d.data()), sum, 1e-14);
  // The hexahedron itself, whichever corner comes first.
  const std::array<Vec3, 8> turned = {p[2], p[3], p[0], p[1], p[6], p[7], p[4], p[5]};
  EXPECT_NEAR(cell_volume(CellShape::hexahedron, turned.data()), cell_volume(CellShape::hexahedron, p.data()),
              1e-14);
}

MixedQuality quality_of(const DistributedMesh& mesh) {
  const NumberedMesh numbered = number_mesh(mesh);
  return measure_quality(numbered, link_faces(numbered));
}

/// Sums over all cells, whatever their shape.
double sum_of(const MixedQuality& quality, Measure measure) {
  double sum = 0;
  for (const CellShape shape : cell_shapes) {
    const MeasureDistribution& of = quality.distribution(shape, measure);
    sum += of.mean * static_cast<double>(of.cells);
  }
  return sum;
}

/// The largest ratio of each cell's volume to a neighbour's, found by comparing faces as sets of points.
std::vector<double> ratios_of(const examples::MixedMesh& whole) {
  std::vector<double> volumes, ratios(whole.cells.size(), 0);
  std::map<std::vector<int>, std::vector<std::size_t>> cells_at;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    std::vector<Vec3> corners;
    for (const int v : whole.cells[c].corners) corners.push_back(whole.points[static_cast<std::size_t>(v)]);
    volumes.push_back(cell_volume(whole.cells[c].shape, corners.data()));
    for (const CellFace& face : faces_of(whole.cells[c].shape)) {
      std::vector<int> key;
      for (std::size_t k = 0; k < 4 && face[k] >= 0; ++k)
        key.push_back(whole.cells[c].corners[static_cast<std::size_t>(face[k])]);
      std::sort(key.begin(), key.end());
      cells_at[key].push_back(c);
    }
  }
  for (const auto& [key, cells] : cells_at) {
    if (cells.size() != 2) continue;
    const double ratio = volume_ratio(volumes[cells[0]], volumes[cells[1]]);
    for (const std::size_t c : cells) ratios[c] = std::max(ratios[c], ratio);
  }
  return ratios;
}

TEST(MixedQuality, WholeMesh) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(4, 3);
  const DistributedMesh mesh = examples::distribute(world, whole, 3);
  const MixedQuality quality = quality_of(mesh);
  const double determinant = 3.001953125;  // of the map of the mixed mesh
  EXPECT_NEAR(quality.volume, 40 * determinant, 1e-10);
  EXPECT_NEAR(quality.region_volumes[1], 16 * determinant, 1e-10);
  EXPECT_NEAR(sum_of(quality, Measure::volume), quality.volume, 1e-10);
  for (const CellShape shape : cell_shapes) {
    for (const Measure measure : all_measures) {
      const MeasureDistribution& of = quality.distribution(shape, measure);
      const auto cells = std::count_if(whole.cells.begin(), whole.cells.end(),
                                       [&](const auto& cell) { return cell.shape == shape; });
      EXPECT_EQ(of.cells, has_measure(shape, measure) ? cells : 0);
      EXPECT_EQ(std::accumulate(of.histogram.counts.begin(), of.histogram.counts.end(), std::int64_t{0}),
                of.cells);
      if (of.cells == 0) continue;
      EXPECT_LE(of.minimum, of.percentiles.front());
      EXPECT_TRUE(std::is_sorted(of.percentiles.begin(), of.percentiles.end()));
      EXPECT_LE(of.percentiles.back(), of.maximum);
      EXPECT_GE(of.mean, of.minimum);
      EXPECT_LE(of.mean, of.maximum);
    }
  }
  const std::vector<double> ratios = ratios_of(whole);
  EXPECT_NEAR(sum_of(quality, Measure::volume_ratio), std::accumulate(ratios.begin(), ratios.end(), 0.0),
              1e-9);
  EXPECT_NEAR(quality.worst_of(Measure::volume_ratio, 0), *std::max_element(ratios.begin(), ratios.end()),
              1e-9);
  EXPECT_GT(quality.distribution(CellShape::prism, Measure::scaled_jacobian).minimum, 0);
  EXPECT_EQ(quality.worst[static_cast<std::size_t>(Measure::edge_ratio)].size(), 10U);
}

void expect_same(const MixedQuality& a, const MixedQuality& b) {
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.region_volumes, b.region_volumes);
  EXPECT_EQ(a.patch_areas, b.patch_areas);
  ASSERT_EQ(a.places.all.size(), b.places.all.size());
  for (std::size_t i = 0; i < a.places.all.size(); ++i) {
    EXPECT_EQ(a.places.all[i].cell, b.places.all[i].cell);
    EXPECT_EQ(a.places.all[i].value, b.places.all[i].value);
    EXPECT_EQ(a.places.all[i].flaw, b.places.all[i].flaw);
  }
  for (const Measure measure : all_measures) {
    const auto m = static_cast<std::size_t>(measure);
    for (const CellShape shape : cell_shapes) {
      const MeasureDistribution &x = a.distribution(shape, measure), &y = b.distribution(shape, measure);
      EXPECT_EQ(x.minimum, y.minimum);
      EXPECT_EQ(x.maximum, y.maximum);
      EXPECT_EQ(x.mean, y.mean);
      EXPECT_EQ(x.percentiles, y.percentiles);
      EXPECT_EQ(x.histogram.counts, y.histogram.counts);
    }
    ASSERT_EQ(a.worst[m].size(), b.worst[m].size());
    for (std::size_t i = 0; i < a.worst[m].size(); ++i) {
      EXPECT_EQ(a.worst[m][i].value, b.worst[m][i].value);
      EXPECT_EQ(a.worst[m][i].cell, b.worst[m][i].cell);
      EXPECT_EQ(a.worst[m][i].center, b.worst[m][i].center);
    }
  }
}

TEST(MixedQuality, TheSameForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world(), self = Communicator::self();
  expect_same(quality_of(examples::mixed_mesh(world, 4, 5)), quality_of(examples::mixed_mesh(self, 4, 5)));
}

/// Prisms over a wall, the second layer `jump` times as high as the first: tetrahedra that know they are of
/// layers where `known`. Each of them is flat.
DistributedMesh thin_layers(const Communicator& world, double jump, bool known) {
  Piece piece;
  constexpr double first = 1e-5;
  piece.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, first, 0, 0, (1 + jump) * first};
  piece.cells = {0, 1, 2, 3, 3, 1, 2, 4};
  if (known) piece.layers = {1, 2};
  DistributedMesh mesh(world);
  mesh.piece_count = 1;
  if (world.is_root()) mesh.pieces.push_back(std::move(piece));
  return mesh;
}

// Cells of layers count, but not for being flat; neighbours of another size do, by the smaller cell.
TEST(MixedQuality, PlacesAreOfAllCells) {
  const Communicator world = Communicator::world();
  const MixedQuality good = quality_of(thin_layers(world, 1.2, true));
  ASSERT_EQ(good.places.all.size(), 2u);
  EXPECT_EQ(verdict_of(good.places.all.front().severity), Verdict::good);
  EXPECT_TRUE(good.places.of[static_cast<std::size_t>(Flaw::small_angle)].empty());
  const MixedQuality jumping = quality_of(thin_layers(world, 11120, true));
  const FlawedCell& worst = jumping.places.all.front();
  EXPECT_EQ(worst.flaw, Flaw::size_jump);
  EXPECT_EQ(worst.cell, 0);
  EXPECT_NEAR(worst.value, 11120, 1e-6);
  EXPECT_EQ(jumping.places.of[static_cast<std::size_t>(Flaw::size_jump)].size(), 1u) << "the smaller alone";
  const MixedQuality unknown = quality_of(thin_layers(world, 1.2, false));
  EXPECT_EQ(verdict_of(unknown.places.all.front().severity), Verdict::good) << "many are flat: of layers";
}

TEST(MixedQuality, PlacesGoByAngleWhereNothingSpeaksOfLayers) {
  const Communicator world = Communicator::world();
  Piece piece;
  for (int i = 0; i < 100; ++i) {
    const double x = 10.0 * i, height = i == 42 ? 1e-3 : 1;
    piece.coordinates.insert(piece.coordinates.end(), {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, height});
    for (int k = 0; k < 4; ++k) piece.cells.push_back(4 * i + k);
  }
  DistributedMesh mesh(world);
  mesh.piece_count = 1;
  if (world.is_root()) mesh.pieces.push_back(std::move(piece));
  const WorstPlaces places = quality_of(mesh).places;
  ASSERT_EQ(places.all.size(), 10u);
  EXPECT_EQ(places.all.front().cell, 42);
  EXPECT_EQ(places.all.front().flaw, Flaw::small_angle);
  EXPECT_EQ(verdict_of(places.all.front().severity), Verdict::poor);
  EXPECT_EQ(places.all[1].cell, 0) << "ties go by number";
}

TEST(MixedQuality, PercentilesOfKnownValues) {
  // Tetrahedra without neighbours, of volumes 1/6, 2/6 ... 1000/6.
  const Communicator world = Communicator::world();
  Piece piece;
  for (int i = 0; i < 1000; ++i) {
    const double x = 10.0 * i;
    piece.coordinates.insert(piece.coordinates.end(), {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, i + 1.0});
    for (int k = 0; k < 4; ++k) piece.cells.push_back(4 * i + k);
  }
  DistributedMesh mesh(world);
  mesh.piece_count = 1;
  if (world.is_root()) mesh.pieces.push_back(std::move(piece));
  const MixedQuality quality = quality_of(mesh);
  const MeasureDistribution& volume = quality.distribution(CellShape::tetrahedron, Measure::volume);
  const std::array<double, 7> expected = {1, 10, 50, 500, 950, 990, 999};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LE(volume.percentiles[i], expected[i] / 6 * (1 + 1e-12));
    EXPECT_GE(volume.percentiles[i], expected[i] / 6 / 1.0117);
  }
  EXPECT_EQ(volume.histogram.edge(80), 1);
  EXPECT_EQ(quality.distribution(CellShape::tetrahedron, Measure::volume_ratio).cells, 0);
  EXPECT_EQ(quality.defects.open_faces, 4000);
  const auto& worst = quality.worst[static_cast<std::size_t>(Measure::volume)];
  EXPECT_EQ(worst.front().cell, 0);
  EXPECT_NEAR(worst.front().center.z, 0.25, 1e-15);
}

}  // namespace
}  // namespace aeroloom::mesh
