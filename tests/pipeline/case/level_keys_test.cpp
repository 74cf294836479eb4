#include "tests/pipeline/case/case_fixture.hpp"

#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

class LevelKeys : public CaseTest {};

TEST_F(LevelKeys, ComeBack) {
  const Case input = read(
      "geometry: {file: a.step}\nsizing: {level: fine, budget: 5e7, family: dpw, solver: cell, flow: [0, 0, "
      "2], lifting: ['wing_*', tail]}\n");
  EXPECT_EQ(input.sizing.lifting, (std::vector<std::string>{"wing_*", "tail"}));
  EXPECT_EQ(input.sizing.budget, 5e7);
  EXPECT_EQ(input.sizing.level, sizing::Level::fine);
  EXPECT_EQ(input.sizing.family, sizing::LevelFamily::dpw);
  EXPECT_EQ(input.sizing.solver, sizing::SolverPoints::cell);
  EXPECT_EQ(input.domain.default_far_field.flow, cad::Axis::z);
  const Case again = case_of_resolved(resolved_yaml(input));
  EXPECT_EQ(again.sizing.level, input.sizing.level);
  EXPECT_EQ(again.sizing.budget, input.sizing.budget);
  EXPECT_EQ(again.sizing.family, input.sizing.family);
  EXPECT_EQ(again.sizing.solver, input.sizing.solver);
  EXPECT_EQ(again.sizing.flow, input.sizing.flow);
  EXPECT_EQ(again.sizing.lifting, input.sizing.lifting);
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
}

TEST_F(LevelKeys, PutTheFarFieldAwayUnlessItIsGiven) {
  const Case far = read("geometry: {file: a.step}\nsizing: {level: A}\n");
  EXPECT_FALSE(far.domain.far_field);
  EXPECT_EQ(far.domain.default_far_field.extent, 100);
  EXPECT_EQ(far.domain.default_far_field.unit, cad::ExtentUnit::semispan);
  const Case half = read("geometry: {file: a.step}\nfarfield: {symmetry: y}\nsizing: {level: A}\n");
  ASSERT_TRUE(half.domain.far_field);
  EXPECT_EQ(half.domain.far_field->extent, 100);
  EXPECT_EQ(half.domain.far_field->unit, cad::ExtentUnit::semispan);
  const Case near = read("geometry: {file: a.step}\nfarfield: {extent: 20}\nsizing: {level: A}\n");
  EXPECT_EQ(near.domain.far_field->extent, 20);
  EXPECT_EQ(near.domain.far_field->unit, cad::ExtentUnit::body);
  const Case chords = read(
      "geometry: {file: a.step}\nfarfield: {extent: 1000, unit: reference_length}\n"
      "sizing: {level: A, reference_length: 7}\n");
  EXPECT_EQ(chords.domain.far_field->unit, cad::ExtentUnit::reference);
  EXPECT_EQ(chords.domain.far_field->unit_length, 7);
  EXPECT_EQ(case_of_resolved(resolved_yaml(chords)).domain.far_field->unit_length, 7);
  EXPECT_NE(error_of("geometry: {file: a.step}\nfarfield: {unit: reference_length}\n")
                .find("needs 'sizing.reference_length'"),
            std::string::npos);
  const Case none = read("geometry: {file: a.step}\n");
  EXPECT_EQ(none.domain.default_far_field.extent, 10);
}

TEST_F(LevelKeys, LeaveNothingToChoose) {
  const auto refused = [&](const std::string& sizing) {
    return error_of("geometry: {file: a.step}\nsizing: {" + sizing + "}\n");
  };
  EXPECT_NE(refused("level: B, target_tetrahedra: 1000").find("none left to choose"), std::string::npos);
  EXPECT_NE(refused("level: B, family: dpw").find("dpw has coarse"), std::string::npos);
  EXPECT_NE(refused("family: dpw").find("'sizing.family: dpw' needs"), std::string::npos);
  EXPECT_NE(refused("budget: 1e6").find("needs 'sizing.level'"), std::string::npos);
  EXPECT_NE(refused("lifting: ['wing*']").find("'sizing.lifting' needs 'sizing.level'"), std::string::npos);
  EXPECT_NE(refused("level: G").find("'sizing.level'"), std::string::npos);
  EXPECT_NE(refused("level: B, flow: [0, 0, 0]").find("must not be zero"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
