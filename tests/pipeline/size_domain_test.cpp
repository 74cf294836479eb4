#include "pipeline/size_domain.hpp"

#include "parallel/warnings.hpp"
#include "pipeline/stage_products.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad::Model;

SizedDomain size(const Model& model, double minimum, NarrowFaces narrow_faces) {
  SizingRequest request;
  request.minimum = minimum;
  request.maximum = 1;
  parallel::StageClock clock;
  return size_domain(parallel::Communicator::world(), model, request, narrow_faces, clock);
}

TEST(SizeDomain, JoinsNarrowFacesAndSaysSo) {
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain joined = size(model, 0.1, NarrowFaces::join);
  EXPECT_EQ(joined.model.face_count(), model.face_count() - 1);
  ASSERT_EQ(joined.joined.changes.size(), 1u);
  EXPECT_TRUE(joined.joined.changes[0].where);
  EXPECT_NE(joined.joined.changes[0].what.find("joined with"), std::string::npos);
  EXPECT_LT(joined.joined.changes[0].how_much, 1e-6);
  const SizedDomain kept = size(model, 0.1, NarrowFaces::keep);
  EXPECT_EQ(kept.model.face_count(), model.face_count());
  EXPECT_TRUE(kept.joined.changes.empty());
  // Half-way up, where the strip's ends are far away, its width asks for nothing any more.
  EXPECT_GT(joined.field({1, 0, 0.75}), 2 * kept.field({1, 0, 0.75}));
}

TEST(SizeDomain, LeavesFacesAsWideAsElements) {
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  EXPECT_TRUE(size(model, 0.01, NarrowFaces::join).joined.changes.empty());
}

// Sizes from the model go by what is left of it.
TEST(SizeDomain, ChoosesSizesForTheJoinedModel) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  SizingRequest request;
  request.target_tetrahedra = 20'000;
  parallel::StageClock clock;
  const auto world = parallel::Communicator::world();
  const SizedDomain sized = size_domain(world, model, request, NarrowFaces::join, clock);
  ASSERT_EQ(sized.joined.changes.size(), 1u);
  const double predicted = sizing::predict_counts(world, sized.model, sized.field, clock).tetrahedra;
  EXPECT_GT(predicted, 14'000);
  EXPECT_LT(predicted, 28'000);
}

// The search goes around what is given; where that forbids the target, a warning names the key and the count.
TEST(SizeDomain, MeetsTheTargetWhateverElseIsGiven) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  parallel::StageClock clock;
  const auto world = parallel::Communicator::world();
  const std::vector<void (*)(SizingRequest&)> keys{
      [](SizingRequest& request) { request.growth = 1.15; },
      [](SizingRequest& request) { request.curvature_angle = 6; },
      [](SizingRequest& request) { request.chordal_deviation = 0.002; },
      [](SizingRequest& request) { request.minimum = 0.01; },
      [](SizingRequest& request) { request.proximity = 3; },
      [](SizingRequest& request) { request.maximum = 0.4; },
  };
  int met = 0;
  for (unsigned chosen = 0; chosen < 1u << keys.size(); chosen += 3) {
    SizingRequest request;
    request.target_tetrahedra = 30'000;
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (chosen >> k & 1) keys[k](request);
    parallel::take_warnings(world);
    const SizedDomain sized = size_domain(world, model, request, NarrowFaces::join, clock);
    const parallel::Warnings warnings = parallel::take_warnings(world);
    const double share = sized.features ? sized.features->share.share : 1;
    const double error = std::log(sized.counts.tetrahedra / share / 30'000);
    met += std::abs(error) < std::log(1.25);
    if (std::abs(error) > std::log(1.25) && world.is_root()) {
      EXPECT_GT(error, 0) << chosen;
      ASSERT_FALSE(warnings.kept.empty()) << chosen;
      EXPECT_NE(warnings.kept.back().message.find("makes it"), std::string::npos)
          << warnings.kept.back().message;
    }
    EXPECT_EQ(sized.sizes, sizing::with_given(sized.sizes, request)) << chosen;
  }
  EXPECT_GE(met, 8);
}

// A target that a key forbids: which, and what it costs.
TEST(SizeDomain, NamesTheKeyThatForbidsTheTarget) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  parallel::StageClock clock;
  const auto world = parallel::Communicator::world();
  parallel::take_warnings(world);
  SizingRequest request;
  request.target_tetrahedra = 1000;
  request.curvature_angle = 4;
  request.minimum = 0.01;
  const SizedDomain sized = size_domain(world, model, request, NarrowFaces::join, clock);
  const parallel::Warnings warnings = parallel::take_warnings(world);
  EXPECT_GT(sized.counts.tetrahedra, 2000);
  if (!world.is_root()) return;
  ASSERT_EQ(warnings.kept.size(), 1u);
  EXPECT_NE(warnings.kept[0].message.find("sizing.curvature_angle makes it"), std::string::npos)
      << warnings.kept[0].message;
  EXPECT_EQ(warnings.kept[0].message.find("sizing.growth makes it"), std::string::npos)
      << warnings.kept[0].message;
}

// Bounds that were chosen follow those that are given.
TEST(SizeDomain, LetsChosenBoundsFollowGivenOnes) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  parallel::StageClock clock;
  SizingRequest request;
  request.target_tetrahedra = 1000;
  request.surface_maximum = 0.05;
  const auto sized = size_domain(parallel::Communicator::world(), model, request, NarrowFaces::join, clock);
  EXPECT_EQ(sized.sizes.surface_maximum, 0.05);
  EXPECT_LE(sized.sizes.minimum, 0.05);
}

// What the budget cannot resolve is told with its face, width and place, and what it would take.
TEST(SizeDomain, TellsWhichStripsTheBudgetLeavesUnresolved) {
  const Model model = cad::shapes::blunt_wedge(0.0005);
  SizingRequest request;
  request.target_tetrahedra = 20'000;
  parallel::StageClock clock;
  const auto size_within = [&](double budget) {
    request.feature_budget = budget;
    return size_domain(parallel::Communicator::world(), model, request, NarrowFaces::join, clock);
  };
  const SizedDomain small = size_within(2);
  ASSERT_TRUE(small.features);
  ASSERT_EQ(small.features->strips.size(), 3u) << "the blunt end, and the sides beside it";
  EXPECT_NEAR(small.features->strips[0].width, 0.0005, 1e-6);
  EXPECT_NEAR(small.features->strips[0].place.x, 1, 1e-9);
  const double floor = small.features->share.floor;
  EXPECT_GT(floor, 0.0005);
  EXPECT_NEAR(std::tan(small.features->strips[0].surface_degrees * std::numbers::pi / 180), 0.0005 / floor,
              1e-6);
  EXPECT_GT(small.features->wanted_tetrahedra(), 2 * 20'000);
  const std::string text = describe(*small.features);
  EXPECT_NE(text.find("'" + small.features->strips[0].face + "'"), std::string::npos) << text;
  EXPECT_NE(text.find("sizing.feature_budget"), std::string::npos) << text;
  const SizedDomain large = size_within(500);
  ASSERT_TRUE(large.features);
  EXPECT_TRUE(large.features->strips.empty());
  EXPECT_TRUE(describe(*large.features).empty());
  EXPECT_LT(large.sizes.strip_minimum, 0.0005);
  EXPECT_NEAR(large.counts.tetrahedra, small.features->wanted_tetrahedra(),
              0.4 * small.features->wanted_tetrahedra());
}

io::CheckpointContent as_read(const io::CheckpointDraft& draft) {
  parallel::Bytes common = draft.common;
  parallel::Communicator::world().broadcast(common);
  return {std::move(common), {}};
}

// What a checkpoint gives back is what was put in.
TEST(SizeDomain, ComesBackFromACheckpoint) {
  const auto world = parallel::Communicator::world();
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain sized = size(model, 0.1, NarrowFaces::join);
  const SizedDomain found = unpack_sizes(world, as_read(pack_sizes(sized)), model);
  EXPECT_EQ(found.field.digest(), sized.field.digest());
  EXPECT_EQ(found.field.leaf_count(), sized.field.leaf_count());
  EXPECT_EQ(found.field({1, 0, 0.75}), sized.field({1, 0, 0.75}));
  EXPECT_EQ(found.sizes, sized.sizes);
  EXPECT_EQ(found.model.face_count(), sized.model.face_count());
  EXPECT_EQ(found.joined.groups, sized.joined.groups);
  EXPECT_EQ(found.joined.changes.at(0).what, sized.joined.changes.at(0).what);
}

// Where joined faces could not be meshed, the surface is that of other sizes than the stage before has kept.
TEST(SizeDomain, OtherSizesComeWithTheSurface) {
  const auto world = parallel::Communicator::world();
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain joined = size(model, 0.1, NarrowFaces::join), kept = size(model, 0.1, NarrowFaces::keep);
  const mesh::DistributedMesh empty;
  SizedDomain sized = joined;
  const auto with = pack_surface(world, {empty, kept.field, {}, kept, true});
  EXPECT_TRUE(unpack_surface(world, as_read(with), model, sized));
  EXPECT_TRUE(sized.joined.groups.empty());
  EXPECT_EQ(sized.field.digest(), kept.field.digest());
  sized = joined;
  const auto without = pack_surface(world, {empty, kept.field, {}, kept, false});
  EXPECT_FALSE(unpack_surface(world, as_read(without), model, sized));
  EXPECT_EQ(sized.field.digest(), joined.field.digest());
}

}  // namespace
}  // namespace aeroloom::pipeline
