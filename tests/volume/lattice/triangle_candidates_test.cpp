#include "volume/lattice/triangle_candidates.hpp"

#include "tests/meshes/surfaces.hpp"

#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Small boxes in and around a cube with a ball, and what the whole surface says of points in them.
class NearTrianglesOfBoxes : public ::testing::Test {
protected:
  template <class Visit>
  void for_each_point(const Visit& visit) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-3.5, 3.5), part(0, 1);
    for (int b = 0; b < 200; ++b) {
      const Vec3 low{place(random), place(random), place(random)};
      const Box box{low, low + Vec3{0.3, 0.2, 0.4}};
      const double radius = 0.2 + part(random);
      near.collect(boundary, box, radius);
      for (int i = 0; i < 10; ++i)
        visit(low + Vec3{0.3 * part(random), 0.2 * part(random), 0.4 * part(random)}, box, radius);
    }
  }

  surfaces::Surface surface = surfaces::cube_with_ball(3, 5);
  BoundaryDistance boundary{surface.points, surface.triangles};
  TriangleCandidates near;
};

TEST_F(NearTrianglesOfBoxes, know_the_nearest_within_the_radius) {
  int seen = 0, unseen = 0;
  for_each_point([&](Vec3 p, const Box&, double radius) {
    const auto of_all = boundary.nearest(p);
    const auto of_near = near.nearest(p);
    ASSERT_EQ(of_near.has_value(), of_all.distance < radius);
    ++(of_near ? seen : unseen);
    if (!of_near) return;
    EXPECT_EQ(of_near->distance, of_all.distance);
    EXPECT_EQ(boundary.distance_to(p, of_near->triangle), of_all.distance);
  });
  EXPECT_GT(seen, 300);
  EXPECT_GT(unseen, 300);
}

TEST_F(NearTrianglesOfBoxes, keep_points_off_each_as_far_as_its_edges_say) {
  int clear = 0, refused = 0;
  for_each_point([&](Vec3 p, const Box&, double radius) {
    const Clearance clearance{0.8, 0.2 * radius, radius / 0.8};
    bool any = false;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto triangle = static_cast<std::int32_t>(t);
      any = any || boundary.distance_to(p, triangle) < clearance.from(boundary.mean_edge(triangle));
    }
    EXPECT_EQ(near.any_nearer(p, clearance), any);
    ++(any ? refused : clear);
  });
  EXPECT_GT(clear, 300);
  EXPECT_GT(refused, 300);
}

TEST_F(NearTrianglesOfBoxes, are_there_where_a_leaf_is) {
  for_each_point([&](Vec3 p, const Box& box, double radius) {
    if (boundary.nearest(p).distance < radius) {
      EXPECT_TRUE(boundary.any_in(box.dilated(radius)));
    }
  });
  EXPECT_FALSE(boundary.any_in(Box{{9, 9, 9}, {10, 10, 10}}));
}

}  // namespace
}  // namespace aeroloom::volume
