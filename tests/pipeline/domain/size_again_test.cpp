// Sizes that are chosen once more, from what the surface stage made of the first.
#include "pipeline/domain/size_domain.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::domain {
namespace {

/// Sizes for a target, and what is chosen once more where the surface stage has asked for `places` and
/// `count` times as many tetrahedra as predicted are to be made.
struct Rechoice {
  SizedDomain first;
  std::optional<SizedDomain> second;
};

Rechoice choose_twice(const cases::SizingRequest& request, const std::vector<sizing::SizeSource>& places,
                      double count) {
  const auto world = parallel::Communicator::world();
  Rechoice choice{
      size_domain(world, cad::shapes::split_cylinder(0.5, 1.5), request, {cases::NarrowFaces::join}), {}};
  const sizing::SizeField field =
      choice.first.field.refined(world.is_root() ? places : std::vector<sizing::SizeSource>());
  choice.second =
      size_again(choice.first, request,
                 {field, places, [&] {
                    const sizing::SampledModel sampled(world, choice.first.model);
                    return std::optional(count * sizing::predict_counts(sampled, field).tetrahedra);
                  }});
  return choice;
}

// What rounds of the surface stage asked for stays, and everything else makes room for it.
TEST(SizeAgain, MakesRoomForWhereSizesFell) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  std::vector<sizing::SizeSource> places;
  for (int i = 0; i < 6; ++i) places.push_back({{std::cos(1.0 * i), std::sin(1.0 * i), 0.75}, 0.02});
  const Rechoice choice = choose_twice(request, places, 1);
  ASSERT_TRUE(choice.second);
  EXPECT_GT(choice.second->sizes.surface_maximum, 1.1 * choice.first.sizes.surface_maximum);
  const double counted = choice.second->findings.counts.tetrahedra;
  EXPECT_GT(counted, 16'000);
  EXPECT_LT(counted, 26'000);
  for (const sizing::SizeSource& place : places)
    EXPECT_LT(choice.second->field(place.point), 1.01 * place.size);
  EXPECT_EQ(choice.second->findings.joined.changes.size(), choice.first.findings.joined.changes.size());
  EXPECT_EQ(choice.second->seen.places.size(), places.size());
  EXPECT_GT(choice.second->seen.at_places, 4'000);
}

// Sizes stay where they are given, belong to a family, or the count is as asked.
TEST(SizeAgainLocal, StayWhereNothingIsToBeChosenAgain) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  EXPECT_FALSE(choose_twice(request, {}, 1).second);
  EXPECT_FALSE(choose_twice(request, {{{1, 0, 0.75}, 0.05}}, 1).second);
  const std::vector<sizing::SizeSource> places{{{1, 0, 0.75}, 1e-5}, {{-1, 0, 0.75}, 1e-5}};
  EXPECT_TRUE(choose_twice(request, places, 3).second);
  request.scale = 0.9;
  EXPECT_FALSE(choose_twice(request, places, 3).second);
  cases::SizingRequest given;
  given.minimum = 0.1, given.maximum = 1;
  EXPECT_FALSE(choose_twice(given, places, 3).second);
}

// Forecasts of few elements err: those are checked though no size fell.
TEST(SizeAgainLocal, GetsFinerWhereLessIsMade) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  const Rechoice choice = choose_twice(request, {}, 0.7);
  ASSERT_TRUE(choice.second);
  EXPECT_NEAR(choice.second->seen.bias, 0.7, 0.05);
  EXPECT_LT(choice.second->sizes.surface_maximum, 0.95 * choice.first.sizes.surface_maximum);
}

// What is made over what is predicted counts in the next choice.
TEST(SizeAgainLocal, LearnFromWhatIsMade) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  const std::vector<sizing::SizeSource> places{{{1, 0, 0.75}, 0.015}, {{-1, 0, 0.75}, 0.015}};
  const Rechoice choice = choose_twice(request, places, 1.5);
  ASSERT_TRUE(choice.second);
  EXPECT_NEAR(choice.second->seen.bias, 1.5, 0.1);
  const auto world = parallel::Communicator::world();
  const sizing::SampledModel sampled(world, choice.second->model);
  const double by_field = sizing::predict_counts(sampled, choice.second->field).tetrahedra;
  EXPECT_NEAR(by_field / (20'000 / 1.5), 1, 0.2);
  EXPECT_NEAR(choice.second->findings.counts.tetrahedra / by_field, 1.5, 0.15);
}

TEST(SizeAgainLocal, NotesATargetThatIsMissed) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  SizedDomain sized = choose_twice(request, {}, 1).first;
  note_count(sized, request, 21'000);
  EXPECT_EQ(sized.findings.missed_target, "");
  note_count(sized, request, 40'000);
  EXPECT_NE(sized.findings.missed_target.find("least target that this case meets is about 4e+04"),
            std::string::npos)
      << sized.findings.missed_target;
  EXPECT_TRUE(comes_nearer(22'000, 30'000, sized, request));
  EXPECT_FALSE(comes_nearer(9'000, 30'000, sized, request));
}

}  // namespace
}  // namespace aeroloom::domain
