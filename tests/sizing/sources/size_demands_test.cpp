#include "sizing/sources/size_demands.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;
using Shape = SizeRegion::Shape;

const SizeRegion cone{"cone", Shape::cylinder, {0, 0, 0}, {4, 0, 0}, 1, 2, 0.25};
const SizeRegion ball{"ball", Shape::sphere, {1, 2, 3}, {1, 2, 3}, 1.5, 0, 0.3};
const SizeRegion box{"box", Shape::box, {3, -1, 2}, {-1, 1, 5}, 0, 0, 0.2};

TEST(SizeRegion, TellsHowFarAPointIs) {
  EXPECT_EQ(cone.distance_to({2, 1.4, 0}), 0);
  EXPECT_NEAR(cone.distance_to({-1, 0.5, 0}), 1, 1e-12);
  EXPECT_NEAR(cone.distance_to({5, 0, 2}), 1, 1e-12);
  EXPECT_NEAR(cone.distance_to({0, 0, 2}), 1 / std::hypot(1, 0.25), 1e-12);  // to the slope
  EXPECT_NEAR(cone.distance_to({-3, 0, 5}), 5, 1e-12);                       // to the rim
  EXPECT_EQ(ball.distance_to({1, 2, 4}), 0);
  EXPECT_NEAR(ball.distance_to({1, 2, 6}), 1.5, 1e-12);
  EXPECT_EQ(box.distance_to({0, 0, 3}), 0);
  EXPECT_NEAR(box.distance_to({6, 0, 9}), 5, 1e-12);
  const SizeRegion line{"line", Shape::cylinder, {0, 0, 0}, {4, 0, 0}, 0, 0, 0.1};
  EXPECT_NEAR(line.distance_to({2, 3, 4}), 5, 1e-12);
  EXPECT_NEAR(line.distance_to({7, 0, 4}), 5, 1e-12);
}

bool comes_before(const SizeSource& a, const SizeSource& b) {
  return std::tie(a.point.x, a.point.y, a.point.z) < std::tie(b.point.x, b.point.y, b.point.z);
}

TEST(SizeRegion, IsCoveredBySourcesWhateverTheRanks) {
  const RootCube root(geometry::Box{{-20, -20, -20}, {20, 20, 20}});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const SizeRegion& region : {cone, ball, box}) {
    std::vector<SizeSource> one = sources_in(root, region, region.size, 0, 1), three;
    for (int rank = 0; rank < 3; ++rank) {
      const auto part = sources_in(root, region, region.size, rank, 3);
      three.insert(three.end(), part.begin(), part.end());
    }
    std::sort(one.begin(), one.end(), comes_before);
    std::sort(three.begin(), three.end(), comes_before);
    ASSERT_EQ(one.size(), three.size()) << region.name;
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(distance(one[i].point, three[i].point), 0);
    EXPECT_LE(static_cast<double>(one.size()), 2 * cells_in(root, region, region.size)) << region.name;
    // A source asks for its size in the whole cell around it.
    const double half = 0.5 * std::ldexp(root.edge, -root.level(region.size));
    const geometry::Box around = region.box();
    for (int i = 0; i < 300; ++i) {
      const Vec3 size = around.size();
      const Vec3 p = around.low + Vec3{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
      if (region.distance_to(p) > 0) continue;
      EXPECT_TRUE(std::any_of(one.begin(), one.end(), [&](const SizeSource& s) {
        const Vec3 d = p - s.point;
        return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= half * (1 + 1e-9);
      })) << region.name;
    }
  }
}

TEST(SizeRegion, OffTheRootAsksForNothing) {
  const RootCube root(geometry::Box{{100, 100, 100}, {140, 140, 140}});
  EXPECT_EQ(cells_in(root, ball, ball.size), 0);
  EXPECT_TRUE(sources_in(root, ball, ball.size, 0, 1).empty());
}

}  // namespace
}  // namespace aeroloom::sizing
