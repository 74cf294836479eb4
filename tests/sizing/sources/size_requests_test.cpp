#include "sizing/sources/size_requests.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;
const SizeRegion cone{"cone", ConeShape{{0, 0, 0}, {4, 0, 0}, 1, 2}, 0.25};
const SizeRegion ball{"ball", SphereShape{{1, 2, 3}, 1.5}, 0.3};
const SizeRegion box{"box", BoxShape{{3, -1, 2}, {-1, 1, 5}}, 0.2};
const SizeRegion point{"point", PointShape{{1, -2, 0.5}}, 0.2};
const SizeRegion line{"line", LineShape{{0, 0, 0}, {4, 1, 2}}, 0.2};
const SizeRegion cylinder{"cylinder", CylinderShape{{0, 3, 0}, {4, 3, 1}, 0.75}, 0.25};

bool comes_before(const SizeSource& a, const SizeSource& b) {
  return std::tie(a.point.x, a.point.y, a.point.z) < std::tie(b.point.x, b.point.y, b.point.z);
}

TEST(SizeRegion, IsCoveredBySourcesWhateverTheRanks) {
  const RootCube root(geometry::Box{{-20, -20, -20}, {20, 20, 20}});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const SizeRegion& region : {cone, ball, box, point, line, cylinder}) {
    std::vector<SizeSource> one = sources_in(root, region, region.size, 0, 1), three;
    for (int rank = 0; rank < 3; ++rank) {
      const auto part = sources_in(root, region, region.size, rank, 3);
      three.insert(three.end(), part.begin(), part.end());
    }
    std::sort(one.begin(), one.end(), comes_before);
    std::sort(three.begin(), three.end(), comes_before);
    ASSERT_EQ(one.size(), three.size()) << region.name;
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(distance(one[i].point, three[i].point), 0);
    // A point at a corner is in eight cells.
    EXPECT_LE(static_cast<double>(one.size()), 2 * cells_in(root, region, region.size) + 6) << region.name;
    // A source asks for its size in the whole cell around it.
    const double half = 0.5 * std::ldexp(root.edge, -root.level(region.size));
    const geometry::Box around = box_of(region.shape);
    for (int i = 0; i < 300; ++i) {
      const Vec3 size = around.size();
      const Vec3 p = around.low + Vec3{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
      if (distance_to(region.shape, p) > 0) continue;
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
