#include "layers/cone.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

TEST(SmallestConeLocal, HasItsAxisBetweenTwoNormals) {
  const std::vector<Vec3> normals{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}};
  const NormalCone cone = smallest_cone(normals);
  EXPECT_NEAR(cone.axis.x, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(cone.axis.z, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(cone.visibility, std::sqrt(0.5), 1e-15);
}

TEST(SmallestConeLocal, OfABoxCornerSeesAllThreeSides) {
  const std::vector<Vec3> normals{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  EXPECT_NEAR(smallest_cone(normals).visibility, 1 / std::sqrt(3.0), 1e-15);
}

TEST(SmallestConeLocal, SeesNothingWhereNormalsAreOpposite) {
  const std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
  EXPECT_LE(smallest_cone(normals).visibility, 1e-15);
  EXPECT_LT(smallest_cone({}).visibility, 0);
}

TEST(SmallestConeLocal, NoOtherDirectionSeesMore) {
  std::mt19937 random(3);
  const auto uniform = [&] { return 2 * (random() / 4294967296.0) - 1; };
  for (int round = 0; round < 50; ++round) {
    std::vector<Vec3> normals;
    for (int i = 0; i < 9; ++i) normals.push_back(normalized(Vec3{0.9 * uniform(), 0.9 * uniform(), 0.6}));
    const NormalCone cone = smallest_cone(normals);
    EXPECT_EQ(cone.visibility, visibility_of(cone.axis, normals));
    for (int i = 0; i < 500; ++i) {
      const Vec3 other = normalized(cone.axis + 0.2 * Vec3{uniform(), uniform(), uniform()});
      EXPECT_LE(visibility_of(other, normals), cone.visibility + 1e-12);
    }
  }
}

}  // namespace
}  // namespace aeroloom::layers
