/// The grid of the interior points.
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr double root_size = sizing::grid_size;

TEST(LatticeFrameLocal, leads_to_the_grid_and_back) {
  Random random;
  for (const Box& box : {fields::domain, Box{{9e3, -2e4, 5}, {9.003e3, -1.999e4, 6}}}) {
    const LatticeFrame frame(fields::uniform(0.1, box), box);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 grid{random.between(0, root_size), random.between(0, root_size),
                      random.between(0, root_size)};
      EXPECT_LT(distance(frame.to_grid(frame.to_space(grid)), grid),
                1e-4);  // a tenth of what others allow for
    }
  }
}

TEST(LatticeFrameLocal, has_a_root_around_the_box) {
  Random random;
  for (const double size : {0.2, 0.23, 0.26, 0.3, 0.34, 0.38}) {
    const auto field = fields::uniform(size);
    for (const Box& box :
         {fields::domain, Box{{-1e-3, 0, 0}, {1e-3, 2e-3, 1e-3}}, Box{{3, 4, 5}, {30, 5, 6}}}) {
      const LatticeFrame frame(field, box);
      for (int i = 0; i < 100; ++i) {
        Vec3 p = random.in(box);
        if (i < 8)
          p = {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
               i & 4 ? box.high.z : box.low.z};
        const Vec3 g = frame.to_grid(p);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_GT(g[axis], 0);
          EXPECT_LT(g[axis], root_size);
        }
      }
    }
  }
}

TEST(LatticeFrameLocal, is_scaled_to_the_sizes) {
  for (const double size : {0.1, 0.15, 0.19}) {
    const LatticeFrame frame(fields::uniform(size), fields::domain);
    double nearest = 1;
    for (int level = 0; level < 12; ++level)
      nearest = std::min(nearest, std::abs(mean_edge_of_cell * frame.edge(level) / size - 1));
    EXPECT_LT(nearest, 1e-9) << size;
  }
}

/// Where two edges are not at right angles the four points are not on a circle.
TEST(LatticeFrameLocal, takes_squares_off_their_circles) {
  const LatticeFrame frame(fields::uniform(0.1), fields::domain);
  const Vec3 edges[3] = {{1e5, 0, 0}, {0, 1e5, 0}, {0, 0, 1e5}};
  Vec3 sheared[3];
  for (int k = 0; k < 3; ++k) {
    sheared[k] = frame.to_space(edges[k]) - frame.to_space({0, 0, 0});
    const double length = frame.edge(0) * 1e5 / root_size;
    EXPECT_NEAR(norm(sheared[k]) / length, 1, 0.01);
  }
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = normalized(sheared[k]), b = normalized(sheared[(k + 1) % 3]);
    EXPECT_GT(std::abs(dot(a, b)), 0.002);
    EXPECT_LT(std::abs(dot(a, b)), 0.05);
  }
}

TEST(LatticeFrameLocal, bounds_distances_and_boxes_in_the_grid) {
  Random random;
  const LatticeFrame frame(fields::uniform(0.1), fields::domain);
  double tightest = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = random.in(fields::domain), b = random.in(fields::domain);
    const double in_grid = distance(frame.to_grid(a), frame.to_grid(b));
    EXPECT_LE(in_grid, frame.grid_distance(distance(a, b)));
    tightest = std::max(tightest, in_grid / frame.grid_distance(distance(a, b)));
    Box box;
    box.add(a), box.add(b);
    const GridBox image = frame.grid_box(box);
    const Vec3 inside = frame.to_grid(random.in(box));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(inside[axis], image.low[axis] - 1e-3);
      EXPECT_LE(inside[axis], image.high[axis] + 1e-3);
    }
  }
  EXPECT_GT(tightest, 0.95);
}

TEST(LatticeFrameLocal, has_tight_boxes_around_cubes) {
  const LatticeFrame frame(fields::uniform(0.1), fields::domain);
  for (const GridCube& cube : {GridCube{}, GridCube{{1 << 18, 0, 3 << 18}, 2}, GridCube{{6, 8, 10}, 19}}) {
    const GridBox grid = GridBox::of(cube);
    Box corners;
    for (int corner = 0; corner < 8; ++corner)
      corners.add(
          frame.to_space({corner & 1 ? grid.high.x : grid.low.x, corner & 2 ? grid.high.y : grid.low.y,
                          corner & 4 ? grid.high.z : grid.low.z}));
    const Box around = frame.box_around(cube);
    const double rounding = 1e-12 * frame.edge(0);
    EXPECT_LT(distance(around.low, corners.low), rounding);
    EXPECT_LT(distance(around.high, corners.high), rounding);
    EXPECT_LT(distance(frame.middle_of(cube), corners.center()), rounding);
  }
}

TEST(LatticeFrameLocal, finds_the_nearest_cell_of_any_place) {
  const LatticeFrame frame(fields::uniform(0.1), fields::domain);
  const sizing::GridPoint inside = frame.cell_at({5.99, 7, 0.01});
  EXPECT_EQ(inside.x, 5u);
  EXPECT_EQ(inside.y, 7u);
  EXPECT_EQ(inside.z, 0u);
  const sizing::GridPoint outside = frame.cell_at({-3, root_size, 1e300});
  EXPECT_EQ(outside.x, 0u);
  EXPECT_EQ(outside.y, sizing::grid_size - 1);
  EXPECT_EQ(outside.z, sizing::grid_size - 1);
}

TEST(GridBoxLocal, knows_gaps_and_touching) {
  const GridBox a{{0, 0, 0}, {4, 4, 4}};
  EXPECT_EQ(a.gap_to({{7, 8, 2}, {9, 9, 3}}), 5);
  EXPECT_EQ((GridBox{{7, 8, 2}, {9, 9, 3}}).gap_to(a), 5);
  EXPECT_EQ(a.gap_to({{4, 4, 4}, {5, 5, 5}}), 0);
  EXPECT_TRUE(a.overlaps({{4, 4, 4}, {5, 5, 5}}));
  EXPECT_FALSE(a.overlaps({{0, 0, 4.5}, {4, 4, 5}}));
  EXPECT_TRUE(a.dilated(0.5).overlaps({{0, 0, 4.5}, {4, 4, 5}}));
}

}  // namespace
}  // namespace aeroloom::volume
