#include "sizing/choice/choose_sizes.hpp"
#include "sizing/choice/narrow_regions.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

constexpr double no_budget = 1e9;

/// A factory of fields of a shape.
class Sampled {
public:
  explicit Sampled(const cad::Model& model) : Sampled(model, 0) {}
  /// With gaps looked for.
  Sampled(const cad::Model& model, double layers)
      : _factory(SampledModel(parallel::Communicator::world(), model), {layers}, Fields::several) {}

  FeatureResolution share(FeatureBudget budget, std::int64_t most_leaves = 1'000'000'000) {
    return choose_feature_resolution(_factory, sizes(), budget, 1, most_leaves);
  }
  double predict(const FeatureResolution& features) {
    return predict_counts(_factory.sampled(), field(features)).tetrahedra;
  }
  SizeField field(const FeatureResolution& features) {
    SizingOptions options = sizes();
    set_features(options, features);
    return _factory.build_field(options);
  }
  std::vector<NarrowRegion> strips(double width) {
    return narrow_regions_below(_factory.sampled(), width, sizes().minimum);
  }
  ChosenSizes choose(double target, double budget) { return choose_sizes(_factory, target, budget); }

  static SizingOptions sizes() {
    SizingOptions options{0.05, 0.2, 15, 1.3, 0};
    options.feature_minimum = options.minimum;
    return options;
  }

private:
  FieldFactory _factory;
};

TEST(FeatureResolution, ABluntEndIsResolvedWhereTheBudgetAllows) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureResolution all = wedge.share({no_budget});
  EXPECT_GT(all.ratio, 2);
  EXPECT_FALSE(all.limited);
  EXPECT_EQ(all.resolved_ratio, all.ratio);
  EXPECT_EQ(all.aspect, 1);
  EXPECT_DOUBLE_EQ(all.ratio, wedge.predict(all) / wedge.predict({}));
}

TEST(FeatureResolution, StaysWithinTheBudgetAndUsesIt) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureResolution all = wedge.share({no_budget});
  double last_aspect = no_aspect;
  for (const double part : {0.25, 0.5}) {
    const double budget = 1 + part * (all.ratio - 1);
    const FeatureResolution some = wedge.share({budget});
    EXPECT_LE(some.ratio, budget);
    EXPECT_GT(some.ratio, 0.8 * budget);
    EXPECT_GT(some.aspect, 1);
    EXPECT_LT(some.aspect, last_aspect) << "a larger budget resolves more";
    EXPECT_TRUE(some.limited);
    EXPECT_NEAR(some.resolved_ratio, all.ratio, 0.25 * all.ratio);
    last_aspect = some.aspect;
  }
  EXPECT_EQ(wedge.share({1}).aspect, no_aspect);
}

// Thinner than a thousandth of the smallest size at first, strips got nothing; budgets in between more than
// larger ones.
TEST(FeatureResolution, LargerBudgetsNeverGiveLess) {
  for (const double thickness : {0.01, 0.002, 0.0004}) {
    Sampled wedge(cad::shapes::blunt_wedge(thickness));
    FeatureResolution last = wedge.share({1}, 200'000);
    for (const double budget : {1.2, 1.5, 2.0, 3.0, 5.0, 8.0, 13.0, 21.0}) {
      const FeatureResolution some = wedge.share({budget}, 200'000);
      EXPECT_LE(some.aspect, last.aspect) << thickness << ' ' << budget;
      EXPECT_GE(some.ratio, last.ratio) << thickness << ' ' << budget;
      EXPECT_LE(some.ratio, budget);
      if (some.limited) {
        EXPECT_GT(some.ratio, 0.85 * budget) << thickness << ' ' << budget;
      }
      last = some;
    }
  }
}

// Beyond the budget thin and thick parts of an end have elements as much longer than wide.
TEST(FeatureResolution, ThinAndThickStripsHaveOneAspect) {
  constexpr double thick = 0.01, thin = 0.001;
  Sampled wedge(cad::shapes::tapered_wedge(thick, thin));
  const FeatureResolution some = wedge.share({5});
  ASSERT_TRUE(some.limited);
  ASSERT_GT(some.aspect, 1.2);
  ASSERT_LT(some.aspect * thick, Sampled::sizes().minimum);
  const SizeField field = wedge.field(some);
  double least = 1e9, most = 0;
  for (const NarrowRegion& strip : wedge.strips(2 * thick)) {
    if (strip.width > 1.5 * thin) continue;
    EXPECT_NEAR(strip.width, thin, 0.05 * thin);
    least = std::min(least, field(strip.place) / strip.width);
    most = std::max(most, field(strip.place) / strip.width);
  }
  EXPECT_GT(least, 0.5 * some.aspect);
  EXPECT_LT(most, 1.1 * some.aspect);
}

TEST(FeatureResolution, FieldsThatAreFarTooFineAreNotBuilt) {
  Sampled wedge(cad::shapes::blunt_wedge(0.0005));
  const FeatureResolution some = wedge.share({4}, 60'000);
  EXPECT_GT(some.ratio, 1);
  EXPECT_LE(some.ratio, 4);
  EXPECT_TRUE(some.limited);
  EXPECT_GT(some.resolved_ratio, 4);
}

// An end that tapers is not everywhere as thin as at its thinnest place.
TEST(FeatureResolution, TellsWhatEndsWouldTakeThatAreTooFineToTry) {
  for (const double tip : {0.01, 0.0005}) {
    Sampled wedge(cad::shapes::tapered_wedge(0.01, tip));
    const FeatureResolution all = wedge.share({no_budget});
    ASSERT_FALSE(all.limited);
    const FeatureResolution some = wedge.share({no_budget}, wedge.field(all).leaf_count() / 2);
    ASSERT_TRUE(some.limited);
    EXPECT_LT(some.ratio, 0.8 * all.ratio);
    EXPECT_NEAR(some.resolved_ratio, all.ratio, 0.25 * all.ratio) << "tip " << tip;
  }
}

TEST(FeatureResolution, WhereNotEvenTheMinimumCanBeTriedFeaturesStayUnresolved) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureResolution none = wedge.share({no_budget}, 1);
  EXPECT_TRUE(none.limited);
  EXPECT_EQ(none.ratio, 1);
  EXPECT_EQ(none.aspect, no_aspect);
}

TEST(FeatureResolution, WithoutFeaturesThereIsNone) {
  Sampled sphere(make_primitive_domain(cad::PrimitiveKind::box_with_sphere));
  const FeatureResolution none = sphere.share({1.5});
  EXPECT_EQ(none.ratio, 1);
  EXPECT_FALSE(none.limited);
  EXPECT_EQ(none.aspect, 1);
}

// Narrow regions do not take from gaps, nor what gaps take from their budget.
TEST(FeatureResolution, GapsHaveABudgetOfTheirOwn) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {1, 1, 0.01};
  Sampled slot(make_primitive_domain(cad::PrimitiveKind::box, dimensions), 1);
  const FeatureResolution all = slot.share({no_budget, no_budget});
  EXPECT_DOUBLE_EQ(all.gap_floor, 0.01);  // as rays measure it
  EXPECT_GT(all.gap_ratio, 1);
  EXPECT_GE(all.ratio, all.gap_ratio);
  EXPECT_FALSE(all.gaps_limited);
  const FeatureResolution gaps = slot.share({1, no_budget});
  EXPECT_EQ(gaps.gap_ratio, all.gap_ratio);
  EXPECT_EQ(gaps.ratio, gaps.gap_ratio);
  const FeatureResolution half = slot.share({1, 0.5 * all.gap_ratio});
  EXPECT_GT(half.gap_floor, 0.01);
  EXPECT_LE(half.gap_ratio, 0.5 * all.gap_ratio);
  EXPECT_TRUE(half.gaps_limited);
  EXPECT_EQ(slot.share({1}).gap_ratio, 1);
}

TEST(FeatureResolution, RefusesBudgetsThatTakeElementsAway) {
  Sampled sphere(make_primitive_domain(cad::PrimitiveKind::box_with_sphere));
  EXPECT_THROW(sphere.share({0.5}), std::invalid_argument);
}

// The target counts features too. Where they take more than half of it, the budget bounds the whole.
TEST(ChooseSizes, FeaturesCountAndAreBounded) {
  constexpr double target = 20'000;
  for (const double thickness : {0.005, 0.001, 0.0002}) {
    Sampled wedge(cad::shapes::blunt_wedge(thickness));
    const ChosenSizes usual = wedge.choose(target, default_feature_budget);
    EXPECT_GT(usual.counts.tetrahedra, 0.8 * target) << thickness;
    EXPECT_LT(usual.counts.tetrahedra, 1.4 * target) << thickness;
    const ChosenSizes large = wedge.choose(target, 8);
    EXPECT_LT(large.counts.tetrahedra, 1.2 * 8 * target) << thickness;
    if (thickness < 0.002) {
      EXPECT_GT(large.counts.tetrahedra, 2 * target) << thickness;
      EXPECT_LT(large.features.aspect, usual.features.aspect) << thickness;
    }
  }
}

// Gaps have one element across whatever the target. What is then the least target is met.
TEST(ChooseSizes, GapsAreResolvedWhateverTheTarget) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {1, 1, 0.02};
  Sampled slot(make_primitive_domain(cad::PrimitiveKind::box, dimensions), 1);
  const ChosenSizes few = slot.choose(500, default_feature_budget);
  const double least = least_target(few);
  EXPECT_GT(least, 5 * 500);
  EXPECT_LT(few.counts.tetrahedra, 1.4 * least);
  EXPECT_GT(few.counts.tetrahedra, 0.7 * least);
  EXPECT_NEAR(few.field({0.5, 0.5, 0.01}), 0.02, 0.004);
  const ChosenSizes met = slot.choose(least, default_feature_budget);
  EXPECT_GT(met.counts.tetrahedra, 0.8 * least);
  EXPECT_LT(met.counts.tetrahedra, 1.3 * least);
}

}  // namespace
}  // namespace aeroloom::sizing
