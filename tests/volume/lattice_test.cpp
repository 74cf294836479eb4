#include "volume/lattice.hpp"

#include "tests/volume/fields.hpp"
#include "tests/volume/surfaces.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;

std::vector<Vec3> lattice(const ClosedSurface& surface, const sizing::SizeField& field,
                          LatticeOptions options = {}) {
  return body_centred_lattice(BoundaryDistance(surface.points, surface.triangles), field, options).points;
}

bool lies_before(Vec3 a, Vec3 b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

double smallest_ratio_of_distance_to_size(std::vector<Vec3> points, const sizing::SizeField& field) {
  std::sort(points.begin(), points.end(), lies_before);
  double smallest = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size() && points[j].x - points[i].x < 2 * field(points[i]); ++j) {
      smallest = std::min(smallest, distance(points[i], points[j]) / field(points[i]));
    }
  }
  return smallest;
}

TEST(Lattice, has_the_density_asked_for) {
  const double h = 0.1;
  const auto points = lattice(surfaces::cube({0, 0, 0}, 1.9, 20), fields::uniform(h));
  // Two points per cell, whose mean edge is h; the outermost layer is missing.
  const double cell = h / 0.923, expected = 2 * std::pow((3.8 - 2 * 0.75 * h) / cell, 3);
  EXPECT_NEAR(static_cast<double>(points.size()), expected, 0.06 * expected);
}

TEST(Lattice, stays_inside_and_off_the_boundary) {
  const ClosedSurface surface = surfaces::cube_with_ball(14, 12);
  const auto field = fields::around_unit_sphere(0.08, 0.3);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  const Lattice lattice = body_centred_lattice(boundary, field, {});
  ASSERT_GT(lattice.points.size(), 1000u);
  for (const Vec3& p : lattice.scaffold) {
    EXPECT_FALSE(boundary.inside(p));
    EXPECT_LT(norm(p), 1);
  }
  for (const Vec3& p : lattice.points) {
    const auto nearest = boundary.nearest(p);
    EXPECT_TRUE(boundary.inside(p));
    EXPECT_GE(nearest.distance, 0.75 * std::min(boundary.mean_edge(nearest.triangle), 0.9 * field(p)));
  }
}

TEST(Lattice, keeps_distance_between_points_where_sizes_change) {
  const auto field = fields::around_unit_sphere(0.08, 0.5);
  const auto points = lattice(surfaces::cube_with_ball(8, 12), field);
  EXPECT_GT(smallest_ratio_of_distance_to_size(points, field), 0.5);
}

TEST(Lattice, is_a_function_of_position_alone) {
  const auto field = fields::around_unit_sphere(0.08, 0.5);
  const auto whole = lattice(surfaces::cube({0, 0, 0}, 1.9, 10), field);
  const auto corner = lattice(surfaces::cube({0.8, 0.8, 0.8}, 1.0, 10), field);
  std::vector<Vec3> sorted = whole;
  std::sort(sorted.begin(), sorted.end(), lies_before);
  std::size_t common = 0;
  for (const Vec3& p : corner) common += std::binary_search(sorted.begin(), sorted.end(), p, lies_before);
  EXPECT_GT(common, corner.size() * 9 / 10);  // nearly: the clearances differ
  EXPECT_EQ(whole, lattice(surfaces::cube({0, 0, 0}, 1.9, 10), field));
}

TEST(Lattice, covers_pieces_that_reach_out_of_the_domain) {
  const auto field = fields::uniform(0.25);
  const auto points = lattice(surfaces::cube({9, 9, 9}, 1, 8), field);
  EXPECT_GT(points.size(), 400u);
}

TEST(Lattice, variants_differ_slightly) {
  const ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 8);
  const auto field = fields::uniform(0.25);
  const auto first = lattice(surface, field, {.variant = 0}),
             second = lattice(surface, field, {.variant = 1});
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_NE(first[i], second[i]);
    EXPECT_LT(distance(first[i], second[i]), 0.05 * 0.25 * std::sqrt(3.0));
  }
}

TEST(Lattice, gives_up_above_the_largest_count) {
  const auto points =
      lattice(surfaces::cube({0, 0, 0}, 1.9, 20), fields::uniform(0.1), {.largest_count = 1000});
  EXPECT_GT(points.size(), 1000u);
  EXPECT_LT(points.size(), 1010u);
}

}  // namespace
}  // namespace aeroloom::volume
