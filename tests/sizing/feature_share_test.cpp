#include "cad/builtin/primitives.hpp"
#include "sizing/choose_sizes.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

constexpr double no_budget = 1e9;

/// A sampler with its clock.
class Sampled {
public:
  explicit Sampled(const cad::Model& model) : Sampled(model, 0) {}
  /// With gaps looked for.
  Sampled(const cad::Model& model, double layers)
      : _sampler(parallel::Communicator::world(), model, _clock, layers, Fields::several) {}

  FeatureShare share(double budget, std::int64_t most_leaves = 1'000'000'000) {
    return share_of_features(_sampler, sizes(), budget, 1, most_leaves);
  }
  double predict(double floor) { return _sampler.predict(field(floor)).tetrahedra; }
  SizeField field(double floor) {
    SizingOptions options = sizes();
    set_feature_floor(options, floor);
    return _sampler.build_field(options);
  }
  ChosenSizes choose(double target, double budget) { return choose_sizes(_sampler, target, budget); }

  static SizingOptions sizes() {
    SizingOptions options{0.05, 0.2, 15, 1.3, 0};
    options.feature_minimum = options.minimum;
    return options;
  }

private:
  parallel::StageClock _clock;
  ModelSampler _sampler;
};

TEST(FeatureShare, ABluntEndIsResolvedWhereTheBudgetAllows) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureShare all = wedge.share(no_budget);
  EXPECT_GT(all.share, 2);
  EXPECT_FALSE(all.limited);
  EXPECT_EQ(all.resolved_share, all.share);
  EXPECT_LT(all.floor, 0.004);
  EXPECT_DOUBLE_EQ(all.share, wedge.predict(all.floor) / wedge.predict(Sampled::sizes().minimum));
}

TEST(FeatureShare, StaysWithinTheBudgetAndUsesIt) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureShare all = wedge.share(no_budget);
  double last_floor = Sampled::sizes().minimum;
  for (const double part : {0.25, 0.5}) {
    const double budget = 1 + part * (all.share - 1);
    const FeatureShare some = wedge.share(budget);
    EXPECT_LE(some.share, budget);
    EXPECT_GT(some.share, 0.8 * budget);
    EXPECT_GT(some.floor, 0.004);
    EXPECT_LT(some.floor, last_floor) << "a larger budget resolves more";
    EXPECT_TRUE(some.limited);
    EXPECT_NEAR(some.resolved_share, all.share, 0.01 * all.share) << "it was tried";
    last_floor = some.floor;
  }
  EXPECT_EQ(wedge.share(1).floor, Sampled::sizes().minimum);
}

TEST(FeatureShare, FieldsThatAreFarTooFineAreNotBuilt) {
  Sampled wedge(cad::shapes::blunt_wedge(0.0005));
  const FeatureShare some = wedge.share(4, 60'000);
  EXPECT_GT(some.share, 1);
  EXPECT_LE(some.share, 4);
  EXPECT_TRUE(some.limited);
  EXPECT_GT(some.resolved_share, 4);
}

// An end that tapers is not everywhere as thin as at its thinnest place.
TEST(FeatureShare, TellsWhatEndsWouldTakeThatAreTooFineToTry) {
  for (const double tip : {0.01, 0.0005}) {
    Sampled wedge(cad::shapes::tapered_wedge(0.01, tip));
    const FeatureShare all = wedge.share(no_budget);
    ASSERT_FALSE(all.limited);
    const FeatureShare some = wedge.share(no_budget, wedge.field(all.floor).leaf_count() / 2);
    ASSERT_TRUE(some.limited);
    EXPECT_LT(some.share, 0.8 * all.share);
    EXPECT_NEAR(some.resolved_share, all.share, 0.25 * all.share) << "tip " << tip;
  }
}

TEST(FeatureShare, WhereNotEvenTheMinimumCanBeTriedFeaturesStayUnresolved) {
  Sampled wedge(cad::shapes::blunt_wedge(0.004));
  const FeatureShare none = wedge.share(no_budget, 1);
  EXPECT_TRUE(none.limited);
  EXPECT_EQ(none.share, 1);
  EXPECT_EQ(none.floor, Sampled::sizes().minimum);
}

TEST(FeatureShare, WithoutFeaturesThereIsNone) {
  Sampled sphere(make_primitive_domain(cad::PrimitiveKind::box_with_sphere));
  const FeatureShare none = sphere.share(1.5);
  EXPECT_EQ(none.share, 1);
  EXPECT_FALSE(none.limited);
  EXPECT_LT(none.floor, Sampled::sizes().minimum);
}

TEST(FeatureShare, GapsGetWhatStripsLeave) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {1, 1, 0.01};
  Sampled slot(make_primitive_domain(cad::PrimitiveKind::box, dimensions), 1);
  const FeatureShare all = slot.share(no_budget);
  EXPECT_EQ(all.gap_floor, 0.01);
  EXPECT_GT(all.gap_share, 1);
  EXPECT_GE(all.share, all.gap_share);
  const FeatureShare none = slot.share(all.share / all.gap_share);
  EXPECT_EQ(none.gap_share, 1);
  EXPECT_EQ(none.share, all.share / all.gap_share);
}

TEST(FeatureShare, RefusesBudgetsThatTakeElementsAway) {
  Sampled sphere(make_primitive_domain(cad::PrimitiveKind::box_with_sphere));
  EXPECT_THROW(sphere.share(0.5), std::invalid_argument);
}

// However thin the blunt end, the rest of the model keeps its sizes, and what the end needs comes on top.
TEST(ChooseSizes, FeaturesComeOnTop) {
  constexpr double target = 20'000, budget = 8;
  Sampled thick(cad::shapes::blunt_wedge(0.005));
  const ChosenSizes usual = thick.choose(target, budget);
  for (const double thickness : {0.001, 0.0002}) {
    Sampled thin(cad::shapes::blunt_wedge(thickness));
    const ChosenSizes chosen = thin.choose(target, budget);
    EXPECT_NEAR(chosen.options.surface_maximum, usual.options.surface_maximum,
                0.1 * usual.options.surface_maximum);
    EXPECT_GT(chosen.counts.tetrahedra, 1.3 * target);
    EXPECT_LT(chosen.counts.tetrahedra, 1.2 * budget * target);
    EXPECT_LT(chosen.options.strip_minimum, 0.5 * chosen.options.minimum);
    EXPECT_NEAR(chosen.counts.tetrahedra / chosen.features.share, target, 0.2 * target);
  }
}

}  // namespace
}  // namespace aeroloom::sizing
