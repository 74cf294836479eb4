#include "sizing/model_sampler.hpp"

#include "cad/model/joined_faces.hpp"
#include "sizing/narrow_faces.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using cad::Model;

Model join_narrow(const Model& model, double width, parallel::StageClock& clock) {
  auto narrow = find_narrow_faces(parallel::Communicator::world(), model, width, 1e-3, clock);
  return cad::join_faces(model, group_narrow_faces(model, narrow, 1e-3));
}

/// Fields and predictions of samplers that were made anew and from one for the model before.
void expect_same(const Model& model, const Model& joined, const SizingOptions& options, Fields fields,
                 parallel::StageClock& clock) {
  const auto world = parallel::Communicator::world();
  ModelSampler before(world, model, clock, options.proximity, fields);
  before.build_field(options);
  const ModelSampler after(std::move(before), joined), anew(world, joined, clock, options.proximity, fields);
  const SizeField field = after.build_field(options), expected = anew.build_field(options);
  ASSERT_EQ(field.leaf_count(), expected.leaf_count());
  for (std::int64_t leaf = 0; leaf < field.leaf_count(); ++leaf)
    ASSERT_EQ(field.leaf(leaf).size, expected.leaf(leaf).size);
  const PredictedCounts counts = after.predict(field), counts_anew = anew.predict(expected);
  EXPECT_NEAR(counts.triangles, counts_anew.triangles, 1e-9 * counts.triangles);
  EXPECT_NEAR(counts.tetrahedra, counts_anew.tetrahedra, 1e-9 * counts.tetrahedra);
}

}  // namespace

TEST(ModelSampler, TakesOverWhatJoiningLeavesAsItIs) {
  parallel::StageClock clock;
  const Model model = cad::shapes::split_cylinder(3, 2);
  const Model joined = join_narrow(model, 0.06, clock);
  ASSERT_LT(joined.face_count(), model.face_count());
  EXPECT_EQ(joined.members(0).size() + joined.face_count() - 1, model.face_count());
  for (const Fields fields : {Fields::one, Fields::several})
    expect_same(model, joined, {0.05, 0.5, 15, 1.3, 0}, fields, clock);
}

// The strip hides that two walls meet in an edge; joined with one of them it must not be taken for a gap.
TEST(ModelSampler, LooksForGapsAnewBesideJoinedFaces) {
  parallel::StageClock clock;
  const Model model = cad::shapes::creased_prism(10);
  const Model joined = join_narrow(model, 0.06, clock);
  SizingOptions options{0.02, 0.5, 15, 1.3, 0};
  options.proximity = 3;
  expect_same(model, joined, options, Fields::several, clock);
}

TEST(ModelSampler, RemembersEstimatesForSizesThatDifferByRounding) {
  parallel::StageClock clock;
  const Model model = cad::shapes::split_cylinder(3, 2);
  const SizingOptions options{0.05, 0.5, 15, 1.3, 0};
  const ModelSampler sampler(parallel::Communicator::world(), model, clock, options.proximity,
                             Fields::several);
  constexpr std::int64_t many = 1'000'000'000;
  const auto exact = sampler.try_sizes(options, many);
  const auto estimate = sampler.estimate_tetrahedra(options, 1, many);
  ASSERT_TRUE(exact && estimate);
  EXPECT_EQ(*estimate, exact->counts.tetrahedra);
  SizingOptions rounded = options, with_floor = options, finer = options;
  rounded.minimum *= 1 + 1e-14;
  with_floor.feature_minimum = smallest_feature_size(options);
  finer.curvature_angle = 8;
  EXPECT_EQ(sampler.estimate_tetrahedra(rounded, 1, many), estimate);
  EXPECT_EQ(sampler.estimate_tetrahedra(with_floor, 1, many), estimate);
  EXPECT_NE(sampler.estimate_tetrahedra(finer, 1, many), estimate);
  EXPECT_NE(sampler.estimate_tetrahedra(options, 2, many), estimate);
  EXPECT_FALSE(sampler.estimate_tetrahedra(options, 1, exact->field.leaf_count() - 1).has_value());
}

}  // namespace aeroloom::sizing
