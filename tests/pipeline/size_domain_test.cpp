#include "pipeline/size_domain.hpp"

#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <numbers>
#include <string>

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
  EXPECT_NEAR(large.counts->tetrahedra, small.features->wanted_tetrahedra(),
              0.4 * small.features->wanted_tetrahedra());
}

}  // namespace
}  // namespace aeroloom::pipeline
