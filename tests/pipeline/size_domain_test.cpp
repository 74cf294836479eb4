#include "pipeline/size_domain.hpp"

#include "tests/cad/strip_shapes.hpp"

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
  ASSERT_EQ(joined.joined.size(), 1u);
  EXPECT_TRUE(joined.joined[0].where);
  EXPECT_NE(joined.joined[0].what.find("joined with"), std::string::npos);
  EXPECT_LT(joined.joined[0].how_much, 1e-6);
  const SizedDomain kept = size(model, 0.1, NarrowFaces::keep);
  EXPECT_EQ(kept.model.face_count(), model.face_count());
  EXPECT_TRUE(kept.joined.empty());
  // Half-way up, where the strip's ends are far away, its width asks for nothing any more.
  EXPECT_GT(joined.field({1, 0, 0.75}), 2 * kept.field({1, 0, 0.75}));
}

TEST(SizeDomain, LeavesFacesAsWideAsElements) {
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  EXPECT_TRUE(size(model, 0.01, NarrowFaces::join).joined.empty());
}

// Sizes from the model go by what is left of it.
TEST(SizeDomain, ChoosesSizesForTheJoinedModel) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  SizingRequest request;
  request.target_tetrahedra = 20'000;
  parallel::StageClock clock;
  const auto world = parallel::Communicator::world();
  const SizedDomain sized = size_domain(world, model, request, NarrowFaces::join, clock);
  ASSERT_EQ(sized.joined.size(), 1u);
  const double predicted = sizing::predict_counts(world, sized.model, sized.field, clock).tetrahedra;
  EXPECT_GT(predicted, 14'000);
  EXPECT_LT(predicted, 28'000);
}

}  // namespace
}  // namespace aeroloom::pipeline
