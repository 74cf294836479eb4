#include "sizing/choice/field_factory.hpp"

#include "cad/model/topology/joined_faces.hpp"
#include "sizing/choice/narrow_regions.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/features/narrow_faces.hpp"
#include "sizing/field/curvature_size.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using cad::Model;

Model join_narrow(const Model& model, double width) {
  auto narrow = find_narrow_faces(parallel::Communicator::world(), model, width, 1e-3);
  return cad::join_faces(model, group_narrow_faces(model, narrow, 1e-3));
}

/// Fields and predictions of factories that were made anew and from one for the model before.
void expect_same(const Model& model, const Model& joined, const SizingOptions& options, Fields fields) {
  const auto world = parallel::Communicator::world();
  FieldFactory before(SampledModel(world, model), gap_demand(options), fields);
  before.build_field(options);
  FieldFactory after(std::move(before), joined),
      anew(SampledModel(world, joined), gap_demand(options), fields);
  const SizeField field = after.build_field(options), expected = anew.build_field(options);
  ASSERT_EQ(field.leaf_count(), expected.leaf_count());
  for (std::int64_t leaf = 0; leaf < field.leaf_count(); ++leaf)
    ASSERT_EQ(field.leaf(leaf).size, expected.leaf(leaf).size);
  const PredictedCounts counts = predict_counts(after.sampled(), field),
                        counts_anew = predict_counts(anew.sampled(), expected);
  EXPECT_NEAR(counts.triangles, counts_anew.triangles, 1e-9 * counts.triangles);
  EXPECT_NEAR(counts.tetrahedra, counts_anew.tetrahedra, 1e-9 * counts.tetrahedra);
}

}  // namespace

TEST(FieldFactory, TakesOverWhatJoiningLeavesAsItIs) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  const Model joined = join_narrow(model, 0.06);
  ASSERT_LT(joined.face_count(), model.face_count());
  EXPECT_EQ(joined.members(0).size() + joined.face_count() - 1, model.face_count());
  for (const Fields fields : {Fields::one, Fields::several})
    expect_same(model, joined, {0.05, 0.5, 15, 1.3, 0}, fields);
}

// Segments of facets leave the curves by far more than this strip is wide, and other ones on each side of it.
TEST(FieldFactory, WidthsOfStripsAreThoseBetweenTheirCurves) {
  constexpr double width = 4e-5;
  const Model model = cad::shapes::half_coin(width);
  const SampledModel sampled(parallel::Communicator::world(), model);
  const std::vector<NarrowRegion> strips = narrow_regions_below(sampled, 0.05, 0.05);
  ASSERT_FALSE(strips.empty());
  EXPECT_NEAR(strips.front().width, width, 0.05 * width);
}

// At a strip the size is that of what lies around it, did it ask for nothing.
TEST(FieldFactory, TellsSizesWithoutFeatures) {
  constexpr double width = 0.002, surface = 0.1;
  const Model model = cad::shapes::blunt_wedge(width);
  FieldFactory factory(SampledModel(parallel::Communicator::world(), model), {0}, Fields::one);
  SizingOptions options;
  options.minimum = 0.02, options.maximum = 0.5, options.surface_maximum = surface;
  options.feature_minimum = 0.001;
  const std::vector<NarrowRegion> strips =
      narrow_regions_below(factory.sampled(), 2 * width, options.minimum);
  ASSERT_FALSE(strips.empty());
  const geometry::Vec3 place = strips.front().place;
  EXPECT_LT(factory.build_field(options)(place), 3 * width);
  const std::vector<double> sizes = factory.sizes_without_features(std::vector{place}, options);
  EXPECT_GT(sizes.at(0), 0.6 * surface);
  EXPECT_LE(sizes.at(0), surface);
}

// The strip hides that two walls meet in an edge; joined with one of them it must not be taken for a gap.
TEST(FieldFactory, LooksForGapsAnewBesideJoinedFaces) {
  const Model model = cad::shapes::creased_prism(10);
  const Model joined = join_narrow(model, 0.06);
  SizingOptions options{0.02, 0.5, 15, 1.3, 0};
  options.proximity = 3;
  expect_same(model, joined, options, Fields::several);
}

// Sizes of a circle of radius 1 that turn by so much are below the minimum; flat faces ask for nothing.
TEST(FieldFactory, TellsOnWhichFacesTheMinimumWins) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  SizingOptions options{0.5, 1, 5, 1.3, 0};
  options.proximity = 0;
  FieldFactory factory(SampledModel(parallel::Communicator::world(), model), {0}, Fields::several);
  const std::vector<BoundedFace> bounded = factory.faces_bounded_by_minimum(options);
  ASSERT_FALSE(bounded.empty());
  for (const BoundedFace& each : bounded) {
    EXPECT_FALSE(model.is_planar(each.face)) << model.face(each.face).name;
    EXPECT_NEAR(each.fraction, 1, 1e-6);
    EXPECT_NEAR(each.degrees, 0.5 * 180 / std::numbers::pi, 0.1);
  }
  options.curvature_angle = 60;
  EXPECT_TRUE(factory.faces_bounded_by_minimum(options).empty());
}

TEST(FieldFactory, RefusesSizesThatNoMachineHolds) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  for (const Fields fields : {Fields::one, Fields::several}) {
    FieldFactory factory(SampledModel(parallel::Communicator::world(), model), {0}, fields);
    const auto refusal = [&](const SizingOptions& options) -> std::string {
      try {
        factory.build_field(options);
      } catch (const std::invalid_argument& error) {
        return error.what();
      }
      return {};
    };
    EXPECT_NE(refusal({1e-7, 1e-7, 15, 1.3, 0}).find("triangles"), std::string::npos);
    EXPECT_NE(refusal({1e-7, 1, 0.1, 1.3, 1e-7}).find("triangles"), std::string::npos);
    EXPECT_NE(refusal({50, 60, 15, 1.3, 0}).find("only"), std::string::npos);
    EXPECT_EQ(refusal({0.1, 1, 15, 1.3, 0}), "");
  }
}

// The far field has no shape to keep.
TEST(CurvatureLimits, LeaveTheFarFieldItsSizes) {
  SizingOptions options{0.001, 10, 10, 1.3, 0};
  options.chordal_deviation = 1e-4;
  EXPECT_EQ(curvature_limits(true, options).deviation, 0);
  const double body = size_for_curvature(0.01, curvature_limits(false, options), 10, options);
  EXPECT_NEAR(0.01 * body * body / 3, 1e-4, 1e-12);
  EXPECT_GT(size_for_curvature(0.01, curvature_limits(true, options), 10, options), 5 * body);
}

TEST(FieldFactory, RemembersEstimatesForSizesThatDifferByRounding) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  const SizingOptions options{0.05, 0.5, 15, 1.3, 0};
  FieldFactory factory(SampledModel(parallel::Communicator::world(), model), gap_demand(options),
                       Fields::several);
  constexpr std::int64_t many = 1'000'000'000;
  const auto exact = factory.try_sizes(options, many);
  const auto estimate = factory.estimate_tetrahedra(options, 1, many);
  ASSERT_TRUE(exact && estimate);
  EXPECT_EQ(*estimate, exact->tetrahedra);
  SizingOptions rounded = options, with_floor = options, finer = options;
  rounded.minimum *= 1 + 1e-14;
  with_floor.feature_minimum = smallest_feature_size(options);
  finer.curvature_angle = 8;
  EXPECT_EQ(factory.estimate_tetrahedra(rounded, 1, many), estimate);
  EXPECT_EQ(factory.estimate_tetrahedra(with_floor, 1, many), estimate);
  EXPECT_NE(factory.estimate_tetrahedra(finer, 1, many), estimate);
  EXPECT_NE(factory.estimate_tetrahedra(options, 2, many), estimate);
  EXPECT_FALSE(factory.estimate_tetrahedra(options, 1, exact->field.leaf_count() - 1).has_value());
}

TEST(FieldFactory, RoughFieldsTellAboutAsManyAndDoSoForAnySizes) {
  const Model model = cad::shapes::split_cylinder(3, 2);
  FieldFactory factory(SampledModel(parallel::Communicator::world(), model), {1}, Fields::several);
  const SizingOptions options{0.02, 0.3, 15, 1.3, 0};
  const PredictedCounts exact = predict_counts(factory.sampled(), factory.build_field(options));
  const CoarseField rough = factory.build_coarse_field(options);
  EXPECT_NEAR(rough.counts.tetrahedra, exact.tetrahedra, 0.25 * exact.tetrahedra);
  EXPECT_NEAR(rough.counts.triangles, exact.triangles, 0.3 * exact.triangles);
  const SizingOptions tiny{2e-4, 1e-3, 1, 1.3, 0};
  const CoarseField of_tiny = factory.build_coarse_field(tiny);
  EXPECT_GT(of_tiny.counts.tetrahedra, 1e9);
  EXPECT_LT(of_tiny.field.leaf_count(), 1'000'000);
}

}  // namespace aeroloom::sizing
