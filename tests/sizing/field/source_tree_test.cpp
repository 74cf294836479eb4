// The least size of many sources is that of all of them, to the last bit.
#include "sizing/field/source_tree.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

TEST(SourceTree, FindsWhatAllSourcesTell) {
  std::mt19937 random(3);
  const auto uniform = [&] { return random() / 4294967296.0; };
  std::vector<SizeSource> sources;
  for (int i = 0; i < 3000; ++i) {
    // Of many sizes, and many of one; some at one place.
    const double size = i % 3 == 0 ? 0.25 : std::pow(10, -4 * uniform());
    const Vec3 point{uniform(), uniform(), i % 7 == 0 ? 0 : uniform()};
    sources.push_back({i % 11 == 0 && i > 0 ? sources.back().point : point, size});
  }
  for (const double slope : {0.0, 0.02, 0.25, 3.0}) {
    const SourceTree tree(sources, slope);
    for (int i = 0; i < 500; ++i) {
      const Vec3 at{3 * uniform() - 1, 3 * uniform() - 1, 3 * uniform() - 1};
      double least = 2;
      for (const SizeSource& source : sources)
        least = std::min(least, source.size + slope * distance(source.point, at));
      ASSERT_EQ(tree.least(at, 2), least);
    }
  }
  EXPECT_EQ(SourceTree({}, 0.3).least({0, 0, 0}, 2), 2);
}

}  // namespace
}  // namespace aeroloom::sizing
