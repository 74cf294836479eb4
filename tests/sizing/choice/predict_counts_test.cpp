#include "sizing/choice/predict_counts.hpp"

#include "parallel/communication/collective_error.hpp"
#include "sizing/choice/choose_sizes.hpp"
#include "sizing/field/facet_integral.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/cad/primitives.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

using namespace aeroloom;
using cad::Model;
using cad::PrimitiveDimensions;
using cad::PrimitiveKind;
using sizing::PredictedCounts;
using sizing::SizeField;
using sizing::SizingOptions;

namespace {

constexpr double pi = std::numbers::pi;

PredictedCounts predict(const Model& model, const SizingOptions& options,
                        const parallel::Communicator& communicator = parallel::Communicator::world()) {
  const SizeField field = sizing::build_size_field(communicator, model, options);
  return sizing::predict_counts(sizing::SampledModel(communicator, model), field);
}

/// The prediction for one size everywhere, with the constants of the integrals.
void expect_uniform(const PredictedCounts& counts, double h, double area, double volume, double tolerance) {
  const double triangles = 4 / std::sqrt(3.0) * area / (h * h), tetrahedra = 11.3 * volume / (h * h * h);
  EXPECT_NEAR(counts.triangles, triangles, tolerance * triangles);
  EXPECT_NEAR(counts.tetrahedra, tetrahedra, tolerance * tetrahedra);
}

}  // namespace

TEST(PredictCounts, MatchesUniformSizesInBoxes) {
  PrimitiveDimensions dimensions;
  dimensions.box = {3, 2, 1.3};
  const Model box = make_primitive_domain(PrimitiveKind::box, dimensions);
  expect_uniform(predict(box, {0.1, 0.1, 12, 1.3, 0}), 0.1, 2 * (3 * 2 + 3 * 1.3 + 2 * 1.3), 3 * 2 * 1.3,
                 0.02);
  dimensions.box = {1, 2, 1};
  const Model aligned = make_primitive_domain(PrimitiveKind::box, dimensions);
  expect_uniform(predict(aligned, {0.05, 0.05, 12, 1.3, 0}), 0.05, 10, 2, 0.02);
}

TEST(PredictCounts, MatchesUniformSizesInCurvedDomains) {
  PrimitiveDimensions dimensions;
  dimensions.radius = 1;
  const Model sphere = make_primitive_domain(PrimitiveKind::sphere, dimensions);
  expect_uniform(predict(sphere, {0.1, 0.1, 12, 1.3, 0}), 0.1, 4 * pi, 4 * pi / 3, 0.03);
  dimensions.radius = 0.3;
  dimensions.major_radius = 1;
  const Model torus = make_primitive_domain(PrimitiveKind::torus, dimensions);
  expect_uniform(predict(torus, {0.05, 0.05, 12, 1.3, 0}), 0.05, 4 * pi * pi * 0.3, 2 * pi * pi * 0.09, 0.03);
}

Model sphere_in_box(double edge, double radius) {
  PrimitiveDimensions dimensions;
  dimensions.box = {edge, edge, edge};
  dimensions.radius = radius;
  return make_primitive_domain(PrimitiveKind::box_with_sphere, dimensions);
}

/// A face cut off along an edge of fine elements may come as needles along it, ten thousand times as long as
/// those: each has room for next to nothing, and is not cut as often as it is longer.
TEST(PredictCounts, NeedlesAlongAFineEdgeCountWhatTheyCoverTogether) {
  constexpr double length = 200, fine = 0.01, bend = 4e-11;
  constexpr int needles = 2000;
  std::vector<sizing::SizeSource> sources;
  for (int i = 0; i < 20000; ++i) sources.push_back({{(i + 0.5) * fine, 0, 0}, fine});
  const SizeField field =
      SizeField::build({{0, -1, -1}, {length, 1, 1}}, sources, SizingOptions{fine, 1, 15, 1.3, 0});
  // Between the edge, slightly bent, and its far end: a fan.
  const auto on_edge = [](int i) {
    const double x = length * i / needles;
    return geometry::Vec3{x, bend * x * (length - x), 0};
  };
  double sum = 0;
  for (int i = 0; i + 1 < needles; ++i)
    sum += sizing::integrate_facet(field, {on_edge(i), on_edge(i + 1), on_edge(needles)});
  double expected = 0;  // sizes are the finest all along
  for (int i = 0; i < needles; ++i) {
    const double x = (i + 0.5) * length / needles;
    expected += length / needles * bend * x * (length - x) / (fine * fine);
  }
  EXPECT_NEAR(sum, expected, 0.05 * expected);
}

TEST(PredictCounts, LeavesOutTheBody) {
  const Model model = sphere_in_box(2, 0.9);
  expect_uniform(predict(model, {0.06, 0.06, 12, 1.3, 0}), 0.06, 24 + 4 * pi * 0.81, 8 - 4 * pi / 3 * 0.729,
                 0.03);
}

TEST(ChooseSizes, HitsTheTarget) {
  const Model model = sphere_in_box(20, 0.5);
  const auto world = parallel::Communicator::world();
  for (const double target : {6e4, 3e5}) {
    const SizingOptions options = sizing::choose_sizes(world, model, target);
    EXPECT_NEAR(predict(model, options).tetrahedra, target, 0.1 * target);
    EXPECT_GT(options.surface_maximum, options.minimum);
    EXPECT_LE(options.surface_maximum, options.maximum);
  }
}

TEST(ChooseSizes, HandsOverTheFieldAndTheCountsItJudgedBy) {
  const Model model = sphere_in_box(20, 0.5);
  sizing::FieldFactory factory(sizing::SampledModel(parallel::Communicator::world(), model), {1},
                               sizing::Fields::several);
  const sizing::ChosenSizes chosen = sizing::choose_sizes(factory, 5e4);
  const SizeField field = factory.build_field(chosen.options);
  EXPECT_EQ(chosen.field.leaf_count(), field.leaf_count());
  EXPECT_EQ(chosen.field({0.5, 0, 0}), field({0.5, 0, 0}));
  EXPECT_EQ(chosen.counts.tetrahedra, predict_counts(factory.sampled(), field).tetrahedra);
  // From sizes near by it finds what is as good.
  const sizing::ChosenSizes nearby =
      sizing::choose_sizes(factory, 5e4, sizing::default_feature_budget, chosen.options);
  EXPECT_EQ(nearby.options, chosen.options);
}

TEST(ChooseSizes, EndsWhereTheTargetIsOutOfReach) {
  const Model model = sphere_in_box(2, 0.02);
  sizing::FieldFactory factory(sizing::SampledModel(parallel::Communicator::world(), model), {1},
                               sizing::Fields::several);
  const sizing::ChosenSizes chosen = sizing::choose_sizes(factory, 100);
  EXPECT_GT(chosen.counts.tetrahedra, 200);
  EXPECT_NEAR(chosen.options.surface_maximum, 0.008, 0.002) << "the coarsest it tries, a fifth of the body";
}

TEST(ChooseSizes, WorksWithoutFarField) {
  PrimitiveDimensions dimensions;
  dimensions.radius = 0.2;
  const Model torus = make_primitive_domain(PrimitiveKind::torus, dimensions);
  const SizingOptions options = sizing::choose_sizes(parallel::Communicator::world(), torus, 1e5);
  EXPECT_NEAR(predict(torus, options).tetrahedra, 1e5, 1e4);
}

TEST(ChooseSizes, RefusesImpossibleTargets) {
  const Model box = cad::make_primitive_domain(PrimitiveKind::box);
  EXPECT_THROW(sizing::choose_sizes(parallel::Communicator::world(), box, 0), std::invalid_argument);
}
