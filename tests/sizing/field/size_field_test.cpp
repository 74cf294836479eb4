#include "sizing/field/size_field.hpp"

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/field_builder.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

using namespace aeroloom;
using geometry::Box;
using geometry::Vec3;
using sizing::SizeField;
using sizing::SizeSource;
using sizing::SizingOptions;

namespace {

Box cube(double half) {
  Box box;
  box.add(Vec3{-half, -half, -half});
  box.add(Vec3{half, half, half});
  return box;
}

class Points {
public:
  explicit Points(unsigned seed) : _random(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_random);
  }
  Vec3 in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 on_sphere(double radius) {
    std::normal_distribution<double> normal;
    const Vec3 v{normal(_random), normal(_random), normal(_random)};
    return radius * geometry::normalized(v);
  }
  /// Mostly near the unit sphere, at all distances from it.
  Vec3 around_sphere() { return on_sphere(1 + uniform(-1, 1) * std::exp(uniform(-6, 2))); }
  std::mt19937_64& generator() { return _random; }

private:
  std::mt19937_64 _random;
};

/// A sphere of radius 1 covered with sources whose size varies along it.
std::vector<SizeSource> sphere_sources(double size) {
  Points points(11);
  std::vector<SizeSource> sources(static_cast<std::size_t>(30 / (size * size)));
  for (SizeSource& source : sources) {
    source.point = points.on_sphere(1);
    source.size = size * (1 + 0.5 * source.point.x + 0.3 * source.point.y * source.point.z);
  }
  return sources;
}

const SizingOptions options{0.02, 1.5, 12, 1.3, 0};

/// Each rank gives all of the sources.
SizeField built_by_all(std::vector<SizeSource> sources) {
  return sizing::FieldBuilder(parallel::Communicator::world(), cube(10), options).build(std::move(sources));
}

}  // namespace

TEST(SizeFieldLocal, StaysWithinItsBounds) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.03), options);
  Points points(1);
  double smallest = 1e300, largest = 0;
  for (int i = 0; i < 100000; ++i) {
    const double h = field(i % 2 ? points.around_sphere() : points.in_cube(12));
    smallest = std::min(smallest, h);
    largest = std::max(largest, h);
  }
  EXPECT_GE(smallest, options.minimum);
  EXPECT_LT(smallest, 1.1 * options.minimum);
  EXPECT_LE(largest, options.maximum);
  EXPECT_DOUBLE_EQ(largest, options.maximum);
}

TEST(SizeFieldLocal, GivesEverySourceItsSize) {
  const auto sources = sphere_sources(0.05);
  const SizeField field = SizeField::build(cube(10), sources, options);
  double sum = 0;
  for (const SizeSource& source : sources) {
    const double asked = std::max(source.size, options.minimum);
    const double ratio = field(source.point) / asked;
    ASSERT_LE(ratio, 1 + 1e-6);
    ASSERT_GE(ratio, 0.85);
    sum += ratio;
  }
  EXPECT_GT(sum / static_cast<double>(sources.size()), 0.94);
}

TEST(SizeFieldLocal, GrowsFromASourceByTheGrowth) {
  const double slope = std::log(options.growth);
  const SizeField field =
      SizeField::build(cube(10), std::vector<SizeSource>{{{0.1, 0.2, 0.3}, 0.05}}, options);
  Points points(3);
  double excess = 0;
  for (int i = 0; i < 2000; ++i) {
    const double distance = std::exp(points.uniform(-2, 1.5));
    const double h = field(Vec3{0.1, 0.2, 0.3} + points.on_sphere(distance));
    // The source rules a whole leaf (edge at most its size, diagonal sqrt 3), and cones are followed within
    // some percent.
    const double exact = 0.05 + slope * distance;
    EXPECT_LE(h, std::min(1.1 * exact, options.maximum) + 1e-12);
    excess += h / std::min(exact, options.maximum) - 1;
    EXPECT_GE(h, std::min(0.97 * (exact - slope * 0.05 * std::sqrt(3.0)), options.maximum));
  }
  EXPECT_LT(std::abs(excess / 2000), 0.05);
}

TEST(SizeFieldLocal, ObeysTheGrowthLimitBetweenAnyTwoPoints) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.03), options);
  Points points(4);
  double steepest = 0;
  int steep = 0;
  const int pairs = 200000;
  for (int i = 0; i < pairs; ++i) {
    const Vec3 p = points.around_sphere(), q = p + points.on_sphere(field(p) * points.uniform(0.2, 3));
    const double slope = std::abs(field(p) - field(q)) / distance(p, q) / std::log(options.growth);
    steepest = std::max(steepest, slope);
    steep += slope > 1.15;
  }
  EXPECT_LT(steepest, 1.7);
  EXPECT_LT(steep, pairs / 1000);
}

TEST(SizeFieldLocal, IsContinuousAcrossLeaves) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.05), options);
  Points points(5);
  for (int i = 0; i < 20000; ++i) {
    const SizeField::Leaf leaf = field.leaf(points.generator()() % field.leaf_count());
    const Vec3 p = leaf.low + leaf.edge * Vec3{points.uniform(0, 1), points.uniform(0, 1), 0};
    const double step = 1e-7 * leaf.edge;
    EXPECT_NEAR(field(p - Vec3{0, 0, step}), field(p + Vec3{0, 0, step}), 1e-6 * field(p));
  }
}

TEST(SizeFieldLocal, DoesNotDependOnTheOrderOfSources) {
  auto sources = sphere_sources(0.05);
  const SizeField one = SizeField::build(cube(10), sources, options);
  Points points(6);
  std::shuffle(sources.begin(), sources.end(), points.generator());
  sources.insert(sources.end(), sources.begin(), sources.begin() + 100);
  const SizeField two = SizeField::build(cube(10), sources, options);
  ASSERT_EQ(one.leaf_count(), two.leaf_count());
  for (int i = 0; i < 50000; ++i) {
    const Vec3 p = points.around_sphere();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(one(p)), std::bit_cast<std::uint64_t>(two(p)));
  }
}

TEST(SizeFieldLocal, IsTheSameOnEveryRank) {
  const auto world = parallel::Communicator::world();
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.05), options);
  Points points(7);
  std::uint64_t hash = 0;
  for (int i = 0; i < 50000; ++i) {
    hash = std::rotl(hash, 5) ^ std::bit_cast<std::uint64_t>(field(points.around_sphere()));
  }
  const auto folded = static_cast<std::int64_t>(hash >> 1);
  EXPECT_EQ(world.minimum(folded), world.maximum(folded));
}

TEST(SizeField, RefinedOnlyLowers) {
  const SizeField field = built_by_all(sphere_sources(0.05));
  const std::vector<SizeSource> more{{{1, 0, 0}, 0.004}, {{3, 3, 3}, 0.05}, {{-5, 0, 0}, 9}};
  const SizeField refined = field.refined(more);
  EXPECT_LE(refined({1, 0, 0}), 0.004 * (1 + 1e-6));
  EXPECT_LE(refined({3, 3, 3}), 0.05 * (1 + 1e-6));
  EXPECT_NEAR(refined({-5, 0, 0}), field({-5, 0, 0}), 0.05 * field({-5, 0, 0}));
  Points points(8);
  for (int i = 0; i < 50000; ++i) {
    const Vec3 p =
        i % 2 ? points.around_sphere() : more[i % 3].point + points.on_sphere(points.uniform(0, 0.5));
    ASSERT_LE(refined(p), field(p) * (1 + 1e-6));
  }
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = points.on_sphere(1);
    if (p.x < 0) {
      ASSERT_NEAR(refined(p), field(p), 1e-6 * field(p));
    }
  }
}

TEST(SizeFieldLocal, ScaledMultipliesEverySize) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.05), options);
  const SizeField scaled = field.scaled(2).scaled(4);
  EXPECT_EQ(scaled.minimum(), 8 * field.minimum());
  EXPECT_EQ(scaled.maximum(), 8 * field.maximum());
  EXPECT_EQ(scaled.leaf(7).size, 8 * field.leaf(7).size);
  Points points(10);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = points.around_sphere();
    ASSERT_EQ(scaled(p), 8 * field(p));
  }
}

TEST(SizeFieldLocal, ScaledMultipliesEveryLengthAndTheGradient) {
  SizingOptions given = options;
  given.surface_maximum = 1.25;
  given.feature_minimum = 0.001;
  given.narrow_minimum = 0.0005;
  given.gap_minimum = 0.004;
  given.chordal_deviation = 0.01;
  given.gap_proximity = 3;
  SizingOptions expected = given;
  expected.minimum *= 4, expected.maximum *= 4, expected.surface_maximum *= 4, expected.feature_minimum *= 4;
  expected.narrow_minimum *= 4, expected.gap_minimum *= 4, expected.chordal_deviation *= 4;
  expected.growth = std::pow(given.growth, 4);
  EXPECT_EQ(SizeField::build(cube(10), {}, given).scaled(4).options(), expected);
}

TEST(SizeField, RefinedKeepsTheGrowthLimit) {
  const SizeField field =
      built_by_all(sphere_sources(0.05)).refined(std::vector<SizeSource>{{{1, 0, 0}, 0.001}});
  Points points(9);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = Vec3{1, 0, 0} + points.on_sphere(std::exp(points.uniform(-8, 0)));
    const Vec3 q = p + points.on_sphere(field(p));
    ASSERT_LT(std::abs(field(p) - field(q)), 1.7 * std::log(options.growth) * distance(p, q));
  }
}

TEST(SizeFieldLocal, CopesWithScalesOfAMillion) {
  const SizingOptions wide{1e-3, 100, 12, 1.3, 0};
  const SizeField field = SizeField::build(cube(500), std::vector<SizeSource>{{{1, 2, 3}, 1e-3}}, wide);
  EXPECT_NEAR(field({1, 2, 3}), 1e-3, 1e-9);
  EXPECT_NEAR(field({1, 2, 4}), 1e-3 + std::log(1.3), 0.02);
  EXPECT_NEAR(field({1, 2, 3.01}), 1e-3 + 0.01 * std::log(1.3), 4e-4);
  EXPECT_DOUBLE_EQ(field({-499, -499, -499}), 100);
  EXPECT_LT(field.leaf_count(), 50000);
}

TEST(SizeFieldLocal, WithoutSourcesIsTheMaximum) {
  const SizeField field = SizeField::build(cube(1), {}, options);
  EXPECT_EQ(field({0.3, 0.2, 0.1}), options.maximum);
  EXPECT_EQ(field({1e9, -1e9, 0}), options.maximum);
}

TEST(SizeFieldLocal, OutsideItIsTheSizeOfTheNearestPointOfTheBox) {
  Box flat;
  flat.add(Vec3{0, 0, 0});
  flat.add(Vec3{8, 2, 1});
  const SizeField field = SizeField::build(flat, std::vector<SizeSource>{{{8, 2, 1}, 0.05}}, options);
  EXPECT_EQ(field({9, 3, 5}), field({8, 2, 1}));
  EXPECT_EQ(field({4, 3, 5}), field({4, 2, 1}));
}

TEST(SizeField, RefusesImpossibleOptions) {
  const auto build = [](SizingOptions bad) { SizeField::build(cube(1), {}, bad); };
  EXPECT_THROW(build({0, 1, 12, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(build({-1, 1, 12, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(build({2, 1, 12, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(build({0.1, 1, 0, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(build({0.1, 1, 180, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(build({0.1, 1, 12, 1, 0}), std::invalid_argument);
  EXPECT_THROW(build({0.1, 1, 12, std::numeric_limits<double>::quiet_NaN(), 0}), std::invalid_argument);
  EXPECT_THROW(build({0.1, 1, 12, 1.3, 0.05}), std::invalid_argument);
  EXPECT_THROW(SizeField::build(Box{}, {}, options), std::invalid_argument);
  EXPECT_THROW(SizeField::build(cube(1), std::vector<SizeSource>{{{0, 0, 0}, 0}}, options),
               std::invalid_argument);
}

TEST(SizeFieldLocal, LeavesDescribeTheField) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.1), options);
  double volume = 0;
  for (std::int64_t i = 0; i < field.leaf_count(); ++i) {
    const SizeField::Leaf leaf = field.leaf(i);
    volume += std::pow(leaf.edge, 3);
    const Vec3 center = leaf.low + 0.5 * leaf.edge * Vec3{1, 1, 1};
    ASSERT_NEAR(leaf.size, field(center), 1e-12);
  }
  EXPECT_NEAR(volume, 8000, 1e-6);
}

TEST(SizeFieldLocal, EvaluatesInWellUnderAMicrosecond) {
  const SizeField field = SizeField::build(cube(10), sphere_sources(0.02), options);
  Points points(10);
  std::vector<Vec3> places(100000);
  for (Vec3& p : places) p = points.around_sphere();
  double fastest = 1e300, sum = 0;
  // The best of a few rounds, of more where the machine is busy.
  for (int round = 0; round < 5 || (round < 50 && fastest > 1e-6 * static_cast<double>(places.size()));
       ++round) {
    const double start = parallel::cpu_seconds();
    for (const Vec3 p : places) sum += field(p);
    fastest = std::min(fastest, parallel::cpu_seconds() - start);
  }
  EXPECT_GT(sum, 0);
#ifdef NDEBUG
  EXPECT_LT(fastest / static_cast<double>(places.size()), 1e-6);
#endif
}

TEST(FieldBuilder, GivesUpOnFieldsThatAreMuchTooFine) {
  const auto world = parallel::Communicator::world();
  const auto builder = [&] { return sizing::FieldBuilder(world, cube(2), options); };
  const auto sources = sphere_sources(0.1);
  const SizeField whole = builder().build(sources);
  const std::int64_t leaves = whole.leaf_count();
  const auto again = builder().build_within(sources, 2 * leaves);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->leaf_count(), leaves);
  for (const std::int64_t divisor : {10, 1000})
    EXPECT_FALSE(builder().build_within(sources, leaves / divisor));
}

TEST(FieldBuilder, BuildsOneFieldOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = parallel::Communicator::world();
  const auto sources = sphere_sources(0.08);
  const SizeField together = sizing::FieldBuilder(world, cube(5), options).build(sources);
  const SizeField alone = SizeField::build(cube(5), sources, options);
  const std::vector<SizeSource> more{{{1, 0, 0}, 0.004}, {{0, 2, 0}, 0.03}};
  // Each rank has a part of them.
  std::vector<SizeSource> own;
  for (std::size_t i = 0; i < more.size(); ++i) {
    if (i % world.size() == static_cast<std::size_t>(world.rank())) own.push_back(more[i]);
  }
  const SizeField refined = together.refined(own);
  const SizeField refined_alone = alone.refined(more);
  ASSERT_EQ(together.leaf_count(), alone.leaf_count());
  ASSERT_EQ(refined.leaf_count(), refined_alone.leaf_count());
  Points points(21);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = points.around_sphere();
    ASSERT_EQ(together(p), alone(p));
    ASSERT_EQ(refined(p), refined_alone(p));
  }
}

TEST(FieldBuilder, AllRanksHearOfAnImpossibleSourceOfOne) {
  const auto world = parallel::Communicator::world();
  for (const double size : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<SizeSource> mine{{{1, 0, 0}, 0.1}};
    if (world.rank() == world.size() - 1) mine.push_back({{0, 1, 0}, size});
    EXPECT_THROW(sizing::FieldBuilder(world, cube(2), options).build(mine), std::invalid_argument);
  }
}

TEST(FieldBuilderLocal, SizesAreThoseOfTheCheapestSource) {
  // A source's cell is at most as wide as its size; what its corners hang on is as far again.
  const auto sources = sphere_sources(0.15);
  const SizeField field = SizeField::build(cube(4), sources, options);
  const double slope = std::log(options.growth);
  Points points(22);
  for (int i = 0; i < 2000; ++i) {
    const SizeField::Leaf leaf =
        field.leaf(static_cast<std::int64_t>(points.uniform(0, 1) * static_cast<double>(field.leaf_count())));
    double nearest = options.maximum, farthest = options.maximum;
    for (const SizeSource& source : sources) {
      const double size = std::max(source.size, options.minimum);
      const double away = distance(source.point, leaf.low);
      nearest = std::min(nearest, size + slope * std::max(0.0, away - 3.2 * size));
      farthest = std::min(farthest, size + slope * away);
    }
    const double h = field(leaf.low);
    ASSERT_GE(h, (1 - 1e-6) * nearest);
    ASSERT_LE(h, 1.05 * farthest) << "hanging ones lie on chords of a cone";
  }
}
