// Sizes at places, walls and edges as a case has them.
#include "sizing/sources/size_demands.hpp"
#include "tests/pipeline/case/case_fixture.hpp"

namespace aeroloom::cases {
namespace {

TEST_F(CaseTest, AnExpressionIsReadAndComesBack) {
  const Case input = read("geometry: {file: a.step}\nsizing:\n  expression: max(0.1, x^2)\n");
  EXPECT_EQ(case_of_resolved(resolved_yaml(input)).sizing.expression, "max(0.1, x^2)");
  const std::string refused = error_of("geometry: {file: a.step}\nsizing:\n  expression: 0.1*size\n");
  EXPECT_NE(refused.find(":3:3: 'sizing.expression'"), std::string::npos) << refused;
  EXPECT_NE(refused.find("\"size\""), std::string::npos) << refused;
}

TEST_F(CaseTest, WallsWakesAndEdgesAreReadAndComeBack) {
  const Case input = read(
      "geometry: {file: a.step}\nsizing:\n  reference_length: 4\n  minimum: 0.5\n"
      "  sources: {w: {shape: wake, behind: wing, direction: [2, 0, 0], length: 3, size: 0.25}}\n"
      "  walls: {near: {faces: ['wing_*'], size: 0.1, distance: 2}}\n"
      "  edges: {root: {between: [wing, body], low: [0, 1, 2], high: [-3, 4, 5], size: 0.5}}\n"
      "patches: {wing: {size: 0.25}}\n");
  const Case again = case_of_resolved(resolved_yaml(input));
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
  EXPECT_EQ(again.domain.smallest_size, 2);
  const SizingRequest sizing = in_model_units(again.sizing);
  EXPECT_EQ(sizing.minimum, 2);
  EXPECT_EQ(sizing.patch_sizes[0].size, 1);
  const sizing::WakeSize wake = wake_of(sizing.sources[0]);
  EXPECT_EQ(wake.direction.x, 1);
  EXPECT_EQ(wake.length, 12);
  EXPECT_EQ(wake.end_size, 1);
  EXPECT_EQ(wall_of(sizing.walls[0]).distance, 8);
  EXPECT_EQ(edge_of(sizing.edges[0]).within->low.x, -12);
}

TEST_F(CaseTest, WallsWakesAndEdgesHaveWhatTheyNeed) {
  const auto refused = [&](const std::string& sizing) {
    return error_of("geometry: {file: a.step}\nsizing: {" + sizing + "}\n");
  };
  EXPECT_NE(refused("walls: {a: {size: 1}}").find("'sizing.walls.a' needs 'distance'"), std::string::npos);
  EXPECT_NE(refused("walls: {a: {faces: ['re:('], size: 1, distance: 1}}").find("no regular expression"),
            std::string::npos);
  EXPECT_NE(refused("walls: {a: {faces: ['re:'], size: 1, distance: 1}}").find("would match all"),
            std::string::npos);
  EXPECT_NE(refused("edges: {a: {size: 1}}").find("needs 'between'"), std::string::npos);
  EXPECT_NE(refused("edges: {a: {size: 1, low: [0, 0, 0]}}").find("needs both"), std::string::npos);
  const std::string wake = "sources: {a: {shape: wake, size: 1, length: 1, direction: ";
  EXPECT_NE(refused(wake + "[0, 0, 0], behind: b}}").find("not zero"), std::string::npos);
  EXPECT_NE(refused(wake + "[1, 0, 0]}}").find("needs either"), std::string::npos);
  EXPECT_NE(refused(wake + "[1, 0, 0], from: [0, 0, 0]}}").find("needs either"), std::string::npos);
  EXPECT_NE(refused(wake + "[1, 0, 0], behind: b, radius: 1}}").find("has no 'radius'"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
