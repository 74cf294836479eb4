#include "mesh/quality/quality.hpp"

#include "mesh/quality/tet_measures.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using geometry::Vec3;
using parallel::Communicator;

const Vec3 regular[4] = {{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}};
const Vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

TEST(QualityLocal, OfTheRegularTetrahedron) {
  const auto& [a, b, c, d] = regular;
  ASSERT_GT(geometry::volume6(a, b, c, d), 0);
  const double angle = std::acos(1.0 / 3) * 180 / M_PI;
  EXPECT_NEAR(dihedral_range(a, b, c, d).smallest, angle, 1e-12);
  EXPECT_NEAR(dihedral_range(a, b, c, d).largest, angle, 1e-12);
  EXPECT_NEAR(mean_ratio(a, b, c, d), 1, 1e-14);
  EXPECT_NEAR(radius_ratio(a, b, c, d), 1, 1e-14);
}

TEST(QualityLocal, OfTheCornerOfACube) {
  const auto& [a, b, c, d] = corner;
  EXPECT_NEAR(dihedral_range(a, b, c, d).smallest, std::acos(1 / std::sqrt(3.0)) * 180 / M_PI, 1e-12);
  EXPECT_NEAR(dihedral_range(a, b, c, d).largest, 90, 1e-12);
  EXPECT_NEAR(mean_ratio(a, b, c, d), 12 * std::pow(0.5, 2.0 / 3) / 9, 1e-14);
  // r = 1 / (3 + sqrt 3), R = sqrt(3) / 2
  EXPECT_NEAR(radius_ratio(a, b, c, d), 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), 1e-14);
}

TEST(QualityLocal, OfInvertedAndFlatTetrahedra) {
  const auto& [a, b, c, d] = corner;
  EXPECT_NEAR(mean_ratio(a, c, b, d), -mean_ratio(a, b, c, d), 1e-15);
  EXPECT_LT(radius_ratio(a, c, b, d), 0);
  EXPECT_EQ(dihedral_range(a, c, b, d).smallest, 0);
  EXPECT_EQ(dihedral_range(a, c, b, d).largest, 180);
  const Vec3 flat{0.3, 0.3, 0};
  EXPECT_EQ(mean_ratio(a, b, c, flat), 0);
  EXPECT_EQ(radius_ratio(a, b, c, flat), 0);
  EXPECT_EQ(dihedral_range(a, b, c, flat).smallest, 0);
  EXPECT_EQ(mean_ratio(a, a, a, a), 0);
  EXPECT_EQ(radius_ratio(a, a, a, a), 0);
}

TEST(QualityLocal, KeepsTinyAnglesAccurate) {
  const double h =
      1e-9;  // a needle of a dihedral angle: the lid is h above the base over an edge of length 1
  const auto range = dihedral_range({0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1, h});
  EXPECT_NEAR(range.smallest / (std::atan(h) * 180 / M_PI), 1, 1e-12);
}

TEST(QualityLocal, IsSimilarityInvariant) {
  const auto& [a, b, c, d] = corner;
  const auto move = [](Vec3 p) { return 1e-6 * Vec3{-p.y, p.x, p.z} + Vec3{3e-6, 2e-6, 0}; };
  EXPECT_NEAR(mean_ratio(move(a), move(b), move(c), move(d)), mean_ratio(a, b, c, d), 1e-12);
  EXPECT_NEAR(radius_ratio(move(a), move(b), move(c), move(d)), radius_ratio(a, b, c, d), 1e-12);
}

TEST(QualityLocal, OfTriangles) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0.5, std::sqrt(0.75), 0}, right{0, 1, 0};
  EXPECT_NEAR(triangle_mean_ratio(a, b, c), 1, 1e-15);
  EXPECT_NEAR(smallest_angle(a, b, c), 60, 1e-12);
  EXPECT_NEAR(smallest_angle(a, b, right), 45, 1e-12);
  EXPECT_NEAR(largest_angle(a, b, right), 90, 1e-12);
  EXPECT_NEAR(triangle_mean_ratio(a, b, right), 4 * std::sqrt(3.0) * 0.5 / 4, 1e-15);
  EXPECT_EQ(triangle_mean_ratio(a, b, {2, 0, 0}), 0);
  EXPECT_EQ(smallest_angle(a, b, {2, 0, 0}), 0);
  EXPECT_EQ(triangle_mean_ratio(a, a, a), 0);
}

TEST(QualityLocal, OfManyTetrahedraIsThatOfEach) {
  Piece piece = examples::cube(Communicator::self(), 4, 1).pieces[0];
  for (std::size_t i = 0; i < piece.coordinates.size(); ++i)  // some are turned inside out
    piece.coordinates[i] += 0.2 * std::sin(static_cast<double>(i * i));
  piece.cells.insert(piece.cells.end(), {0, 0, 0, 0});
  ASSERT_NE(piece.cell_count() % TetMeasures::most, 0);
  TetMeasures of;
  int inverted = 0;
  for (LocalIndex first = 0; first < piece.cell_count(); first += TetMeasures::most) {
    const int count = std::min(TetMeasures::most, piece.cell_count() - first);
    of.measure(piece, first, count);
    for (int i = 0; i < count; ++i) {
      const LocalIndex* v = piece.cell(first + i);
      const Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
      const DihedralRange angles = dihedral_range(p[0], p[1], p[2], p[3]);
      EXPECT_EQ(of.smallest_dihedral[i], angles.smallest);
      EXPECT_EQ(of.largest_dihedral[i], angles.largest);
      EXPECT_EQ(of.mean_ratio[i], mean_ratio(p[0], p[1], p[2], p[3]));
      EXPECT_EQ(of.radius_ratio[i], radius_ratio(p[0], p[1], p[2], p[3]));
      inverted += of.mean_ratio[i] < 0;
    }
  }
  EXPECT_GT(inverted, 10);
}

void expect_same(const Distribution& a, const Distribution& b) {
  EXPECT_EQ(a.minimum, b.minimum);
  EXPECT_EQ(a.maximum, b.maximum);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.percentile_01, b.percentile_01);
  EXPECT_EQ(a.percentile_1, b.percentile_1);
  EXPECT_EQ(a.percentile_5, b.percentile_5);
  EXPECT_EQ(a.histogram.counts, b.histogram.counts);
}

QualitySummary summary_of(const DistributedMesh& mesh) {
  return summarise_quality(number_mesh(mesh));
}

TEST(QualitySummary, IsTheSameBitsForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  const auto a = summary_of(examples::cube(world, 5, 7)), b = summary_of(examples::cube(self, 5, 7));
  expect_same(a.min_dihedral, b.min_dihedral);
  expect_same(a.max_dihedral, b.max_dihedral);
  expect_same(a.mean_ratio, b.mean_ratio);
  expect_same(a.radius_ratio, b.radius_ratio);
  ASSERT_EQ(a.worst.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(a.worst[i].cell, b.worst[i].cell);
    EXPECT_EQ(a.worst[i].value, b.worst[i].value);
    EXPECT_EQ(a.worst[i].center, b.worst[i].center);
  }
}

TEST(QualitySummary, AgreesWithSortedValues) {
  const auto self = Communicator::self();
  const auto mesh = examples::cube(self, 7, 3);
  std::vector<std::pair<double, GlobalIndex>> angles;
  double sum = 0;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const auto p = [&](int k) { return piece.point(piece.cell(c)[k]); };
      angles.push_back(
          {dihedral_range(p(0), p(1), p(2), p(3)).smallest, static_cast<GlobalIndex>(angles.size())});
      sum += angles.back().first;
    }
  }
  std::sort(angles.begin(), angles.end());
  const auto summary = summary_of(mesh);
  const Distribution& found = summary.min_dihedral;
  const auto count = angles.size();
  EXPECT_EQ(found.minimum, angles.front().first);
  EXPECT_EQ(found.maximum, angles.back().first);
  EXPECT_NEAR(found.mean, sum / count, 1e-11);
  const auto at = [&](double share) {
    return angles[static_cast<std::size_t>(std::ceil(share * count)) - 1].first;
  };
  for (const auto& [value, share] :
       {std::pair(found.percentile_01, 0.001), {found.percentile_1, 0.01}, {found.percentile_5, 0.05}}) {
    EXPECT_LE(value, at(share) + 1e-9);
    EXPECT_GE(value, at(share) - 0.01 - 1e-9);
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(summary.worst[i].value, angles[i].first);
    EXPECT_EQ(summary.worst[i].cell, angles[i].second);
  }
  std::int64_t histogram_sum = 0;
  for (const auto bin : found.histogram.counts) histogram_sum += bin;
  EXPECT_EQ(histogram_sum, static_cast<std::int64_t>(count));
  EXPECT_EQ(found.histogram.high, 180);
}

TEST(QualitySummary, OfASurface) {
  const auto world = Communicator::world();
  const auto summary = summary_of(examples::cube_surface(world, 4, 3));
  EXPECT_NEAR(summary.min_dihedral.minimum, 45, 1e-12);
  EXPECT_NEAR(summary.max_dihedral.maximum, 90, 1e-12);
  EXPECT_NEAR(summary.mean_ratio.mean, std::sqrt(3.0) / 2, 1e-12);
  EXPECT_TRUE(summary.radius_ratio.histogram.counts.empty());
}

TEST(QualitySummary, OfAnEmptyMesh) {
  DistributedMesh mesh(parallel::Communicator::world());
  const auto summary = summary_of(mesh);
  EXPECT_EQ(summary.min_dihedral.minimum, 0);
  EXPECT_EQ(summary.mean_ratio.mean, 0);
  EXPECT_TRUE(summary.worst.empty());
}

TEST(QualitySummary, TellsTheCellsBeyondAngles) {
  const auto world = Communicator::world();
  const auto mesh = examples::fan(world, 5);
  CellsOutside beyond{{50, 89}, {}};
  summarise_quality(number_mesh(mesh), &beyond);
  ASSERT_EQ(beyond.cells.size(), mesh.pieces.size());
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    std::vector<LocalIndex> expected;
    for (LocalIndex c = 0; c < mesh.pieces[i].cell_count(); ++c) {
      const LocalIndex* v = mesh.pieces[i].cell(c);
      const auto point = [&](int k) { return mesh.pieces[i].point(v[k]); };
      const DihedralRange range = dihedral_range(point(0), point(1), point(2), point(3));
      if (range.smallest < 50 || range.largest > 89) expected.push_back(c);
    }
    EXPECT_EQ(beyond.cells[i], expected);
  }
}

TEST(QualitySummary, CountsACellThatIsNoNumberAsFlat) {
  const auto self = Communicator::self();
  NumberedMesh mesh = number_mesh(examples::two_tets(self));
  mesh.pieces[0].coordinates[3 * mesh.pieces[0].cells[3]] = std::numeric_limits<double>::quiet_NaN();
  const auto summary = summarise_quality(mesh);
  EXPECT_EQ(summary.mean_ratio.minimum, 0);
  EXPECT_EQ(summary.worst[0].cell, 0);
}

}  // namespace
}  // namespace aeroloom::mesh
