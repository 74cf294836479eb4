// Sizes at places, walls and edges as a case has them.
#include "sizing/sources/size_requests.hpp"
#include "tests/pipeline/case/case_fixture.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

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
  const auto& wake = std::get<sizing::WakeShape>(sizing.sources[0].shape);
  EXPECT_EQ(wake.direction.x, 2);
  EXPECT_EQ(wake.length, 12);
  EXPECT_EQ(wake.end_size, std::nullopt);
  EXPECT_EQ(sizing.sources[0].size, 1);
  EXPECT_EQ(wall_of(sizing.walls[0]).distance, 8);
  EXPECT_EQ(edge_of(sizing.edges[0]).within->low.x, -12);
}

TEST(CaseSizes, RowsAskForTheirHeightAtEndsAndForTheirStretchBetween) {
  SizingRequest given;
  given.reference_length = 2;
  given.edges.push_back({.name = "tip", .between = {"a", "b"}, .height = 0.5, .stretch = 6});
  const SizingRequest sizing = in_model_units(given);
  const sizing::EdgeSize asked = edge_of(sizing.edges[0]);
  EXPECT_EQ(asked.size_at_ends, 1);
  EXPECT_EQ(asked.size, 6);
  EXPECT_EQ(edge_of({.name = "root", .between = {"a"}, .size = 3}).size_at_ends, 0);
}

/// Keys of a source of every shape.
const std::vector<std::string> every_shape{
    "{shape: point, size: 5, center: [1, 2, 3]}",
    "{shape: line, size: 5, from: [1, 2, 3], to: [4, 5, 6]}",
    "{shape: sphere, size: 5, center: [1, 2, 3], radius: 7}",
    "{shape: box, size: 5, low: [1, 2, 3], high: [4, 5, 6]}",
    "{shape: cylinder, size: 5, from: [1, 2, 3], to: [4, 5, 6], radius: 7}",
    "{shape: cone, size: 5, from: [1, 2, 3], to: [4, 5, 6], radius: 7, end_radius: 8}",
    "{shape: wake, size: 5, from: [1, 2, 3], to: [4, 5, 6], direction: [9, 0, 0], length: 7, end_size: 8}"};

TEST_F(CaseTest, EveryShapeComesBackAndScales) {
  static_assert(std::variant_size_v<sizing::SizeShape> == 7, "every_shape has one of each");
  for (std::size_t i = 0; i < every_shape.size(); ++i) {
    const std::string source = "  sources: {a: " + every_shape[i] + "}\n";
    const Case input = read("geometry: {file: a.step}\nsizing:\n  reference_length: 4\n" + source);
    EXPECT_EQ(input.sizing.sources[0].shape.index(), i);
    EXPECT_EQ(resolved_yaml(case_of_resolved(resolved_yaml(input))), resolved_yaml(input));
    // In the model's unit it is what a case with lengths four times as large says; a direction has none.
    std::string larger;
    bool is_direction = false;
    for (const char c : source) {
      is_direction = c == '[' ? larger.ends_with("direction: ") : is_direction && c != ']';
      const bool scales = c >= '1' && c <= '9' && !is_direction;
      larger += scales ? std::to_string(4 * (c - '0')) : std::string(1, c);
    }
    const Case in_model_unit = read("geometry: {file: a.step}\nsizing:\n" + larger);
    Case scaled = input;
    scaled.sizing = in_model_units(input.sizing);
    scaled.sizing.reference_length.reset();
    EXPECT_EQ(resolved_yaml(scaled), resolved_yaml(in_model_unit)) << source;
  }
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

TEST_F(CaseTest, AScaleComesBackAndIsNotOneThatGrowthForbids) {
  EXPECT_EQ(read(transport).sizing.scale, 1);
  const Case input = read(transport + "sizing: {scale: 0.75}\n");
  EXPECT_EQ(case_of_resolved(resolved_yaml(input)).sizing.scale, 0.75);
  const auto refused = [&](const std::string& text) { return error_of(transport + text); };
  const std::string sizes = refused("sizing:\n  growth: 2\n  scale: 2\n");
  EXPECT_NE(sizes.find("case.yaml:4"), std::string::npos) << sizes;
  EXPECT_NE(sizes.find("'sizing.growth', 2, to that power is 4"), std::string::npos) << sizes;
  EXPECT_NE(sizes.find("a scale of at most 1.58"), std::string::npos) << sizes;
  EXPECT_EQ(refused("sizing: {growth: 2, scale: 1.5}\n"), "no error");
  EXPECT_NE(refused("sizing: {scale: 3}\nlayers: {first: 1e-3, growth: 1.3}\n").find("'layers.growth', 1.3"),
            std::string::npos);
  EXPECT_NE(refused("sizing: {scale: 3}\nlayers: {first: 1e-3, patches: {wing: {growth: 1.3}}}\n")
                .find("'layers.patches.wing.growth'"),
            std::string::npos);
  EXPECT_NE(refused("sizing: {scale: 0}\n").find("sizing.scale"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
