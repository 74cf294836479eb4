#include "layers/column_heights.hpp"
#include "pipeline/case/layer_rules.hpp"
#include "tests/pipeline/case/case_fixture.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

using mesh::PatchType;

const std::vector<std::string> patches{"wing", "fan", "farfield", "vane"};
const std::vector<PatchType> types{PatchType::wall, PatchType::wall, PatchType::farfield,
                                   PatchType::interior};

class LayerKeys : public CaseTest {
protected:
  Case with_layers(const std::string& layers, const std::string& more = "") const {
    return read(transport + more + "layers: {" + layers + "}\n");
  }
  std::string refused(const std::string& layers) const {
    return error_of(transport + "layers: {" + layers + "}\n");
  }
  static layers::LayerOptions options_of(const Case& input) {
    return layer_options(input.layers, input.sizing, patches, types);
  }
};

TEST_F(LayerKeys, WithoutTheSectionThereAreNone) {
  const Case input = read(transport);
  EXPECT_FALSE(input.layers.given);
  EXPECT_EQ(resolved_yaml(input).find("layers"), std::string::npos);
  for (const layers::WallLayers& wall : options_of(input).patches) EXPECT_EQ(wall.first, 0);
}

TEST_F(LayerKeys, WithoutAHeightThereAreNone) {
  const Case input = with_layers("walls: auto, until: isotropic");
  EXPECT_FALSE(input.layers.given);
  EXPECT_EQ(resolved_yaml(input), resolved_yaml(read(transport)));
}

TEST_F(LayerKeys, ComeBack) {
  const Case input = with_layers(
      "walls: none, first: 1e-5, constant: 3, growth: 1.3, count: 20, total: 0.5, patches: {wing: {first: "
      "2e-5, "
      "growth: 1.1, constant: 1, count: 7, total: 0.25}, fan: {count: 0}}, elements: tets, fans: all, fit: "
      "count, gate: "
      "{full_area: "
      "0.9}");
  const Case again = case_of_resolved(resolved_yaml(input));
  EXPECT_TRUE(again.layers.given);
  EXPECT_EQ(again.layers.walls, LayeredWalls::none);
  ASSERT_EQ(again.layers.patches.size(), 2u);
  EXPECT_EQ(again.layers.elements, layers::LayerElements::tets);
  EXPECT_EQ(again.layers.fans, layers::FanPlaces::all);
  EXPECT_EQ(again.layers.fit, LayerFit::count);
  EXPECT_EQ(again.layers.gate.full_area, 0.9);
  EXPECT_EQ(again.layers.patches[0].first, 2e-5);
  EXPECT_EQ(again.layers.patches[1].count, 0);
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
}

TEST_F(LayerKeys, WallsGetThemAndNothingElse) {
  const layers::LayerOptions options = options_of(with_layers("first: 1e-3, growth: 1.3, count: 9"));
  ASSERT_EQ(options.patches.size(), 4u);
  for (const int wall : {0, 1}) {
    EXPECT_EQ(options.patches[wall].first, 1e-3);
    EXPECT_EQ(options.patches[wall].growth, 1.3);
    EXPECT_EQ(options.patches[wall].constant, 2);
    EXPECT_EQ(options.patches[wall].count, 9);
  }
  EXPECT_EQ(options.patches[2].first, 0);
}

TEST_F(LayerKeys, PatchesMayHaveOthersOrNone) {
  const layers::LayerOptions options =
      options_of(with_layers("first: 1e-3, total: 0.1, patches: {wing: {first: 2e-3}, fan: {count: 0}}"));
  EXPECT_EQ(options.patches[0].first, 2e-3);
  EXPECT_EQ(options.patches[0].total, 0.1);
  EXPECT_EQ(options.patches[1].first, 0);
  const layers::LayerOptions alone =
      options_of(with_layers("walls: none, patches: {fan: {first: 1e-4, count: 3}}"));
  EXPECT_EQ(alone.patches[0].first, 0);
  EXPECT_EQ(alone.patches[1].first, 1e-4);
  EXPECT_EQ(alone.patches[1].count, 3);
}

TEST_F(LayerKeys, PatchesMustBeWallsOfThisModel) {
  const auto message = [&](const std::string& rule) -> std::string {
    try {
      options_of(with_layers("first: 1e-3, patches: {" + rule + "}"));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("wign: {count: 3}")
                .find("layers.patches.wign: there is no such patch; the nearest name is "
                      "'wing'"),
            std::string::npos);
  EXPECT_NE(message("wign: {count: 3}").find("case.yaml:2:"), std::string::npos)
      << message("wign: {count: 3}");
  EXPECT_NE(message("farfield: {count: 3}").find("is of type farfield"), std::string::npos);
  EXPECT_NE(message("vane: {count: 3}").find("has cells on both sides"), std::string::npos);
  EXPECT_NE(message("vane: {count: 3}").find("Remedy: `side: front`, `back` or `both`"), std::string::npos);
  EXPECT_NE(message("vane: {count: 3}").find("case.yaml:2:"), std::string::npos);
  EXPECT_EQ(message("farfield: {count: 0}"), "");
}

TEST_F(LayerKeys, InnerFacesHaveLayersOnTheSidesThatAreNamed) {
  using layers::InnerSides;
  const std::map<std::string, InnerSides> names{
      {"front", InnerSides::front}, {"back", InnerSides::back}, {"both", InnerSides::both}};
  for (const auto& [name, sides] : names) {
    const Case input = with_layers("first: 1e-3, patches: {vane: {side: " + name + ", growth: 1.4}}");
    const layers::LayerOptions options = options_of(input);
    EXPECT_EQ(layers::inner_sides_of(options, 3), sides);
    EXPECT_EQ(options.patches[3].first, 1e-3);
    EXPECT_EQ(options.patches[3].growth, 1.4);
    EXPECT_EQ(layers::inner_sides_of(options, 0), InnerSides::none);
    EXPECT_EQ(case_of_resolved(resolved_yaml(input)).layers.patches.at(0).side, sides);
  }
  const layers::LayerOptions without = options_of(with_layers("first: 1e-3"));
  EXPECT_EQ(without.patches[3].first, 0) << "walls alone";
  const std::string wrong = refused("first: 1e-3, patches: {vane: {side: left}}");
  EXPECT_NE(wrong.find("layers.patches.vane.side"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("front"), std::string::npos) << wrong;
}

// By which `count` layers are `total` high, if no growth is asked for.
TEST_F(LayerKeys, GrowthFollowsFromCountAndTotal) {
  const auto wall = [&](const std::string& asked, const std::string& more = "") {
    return options_of(with_layers(asked, more)).patches[0];
  };
  const auto height = [](const layers::WallLayers& of) {
    return layers::Heights{of.first, of.growth, of.constant}.total(of.count);
  };
  const layers::WallLayers fitted = wall("first: 1e-3, count: 20, total: 0.1");
  EXPECT_GT(fitted.growth, 1.1);
  EXPECT_LT(fitted.growth, 1.2);
  EXPECT_NEAR(height(fitted), 0.1, 1e-9);
  EXPECT_LE(height(fitted), 0.1) << "none is left out";
  EXPECT_EQ(wall("first: 1e-3, count: 20, total: 5").growth, 1.3) << "at most";
  EXPECT_EQ(wall("first: 1e-3, count: 20, total: 5, growth_maximum: 1.25").growth, 1.25);
  EXPECT_EQ(wall("first: 1e-3, count: 20, total: 0.01").growth, 1);
  EXPECT_EQ(wall("first: 1e-3, count: 20, total: 0.1, growth: 1.2").growth, 1.2);
  EXPECT_EQ(wall("first: 1e-3, count: 20").growth, 1.2);
  EXPECT_EQ(wall("first: 1e-3, count: 20, total: 0.1", "sizing: {level: fine}\n").growth, 1.1);
  const layers::WallLayers of_patch =
      options_of(with_layers("first: 1e-3, count: 20, patches: {wing: {total: 0.1}}")).patches[0];
  EXPECT_NEAR(of_patch.growth, fitted.growth, 1e-12);
}

TEST(EarlyEnd, IsToldWithTheNumberThatIsNeeded) {
  layers::WallLayers asked{.first = 1e-3, .growth = 1.2, .constant = 1, .count = 0, .total = 0};
  EXPECT_EQ(early_end(asked, 1), "") << "nothing ends them";
  const std::int32_t needed = layers::wanted_count(asked, 1);
  asked.count = needed;
  EXPECT_EQ(early_end(asked, 1), "");
  asked.count = 10;
  const std::string text = early_end(asked, 1);
  EXPECT_NE(text.find("10 layers end at 0.026, where the last is 0.74 %"), std::string::npos) << text;
  EXPECT_NE(text.find("; " + std::to_string(needed) + " are needed"), std::string::npos) << text;
  EXPECT_EQ(early_end(asked, 0.004), "") << "small edges";
  asked.count = 0, asked.total = 0.026;
  EXPECT_NE(early_end(asked, 1).find(" are needed"), std::string::npos);
}

TEST(FittedLayers, GrowMoreUntilTheLastOfTheCountMeetsTheSizes) {
  const layers::WallLayers asked{.first = 1e-3, .growth = 1.2, .constant = 2, .count = 30, .total = 0.1};
  const layers::WallLayers fitted = fitted_layers(asked, 1, LayerFit::growth, 1.3);
  EXPECT_NEAR(fitted.growth, std::pow(700, 1.0 / 28), 1e-12);
  EXPECT_EQ(fitted.count, 30);
  EXPECT_EQ(fitted.total, 0);
  EXPECT_EQ(layers::wanted_count(fitted, 1), 30);
  EXPECT_EQ(early_end(fitted, 1), "");
  EXPECT_EQ(change_of_fit(asked, fitted, 1),
            "growth 1.264 for 1.2 and no limit to their height, so that 30 layers end isotropic");
  EXPECT_EQ(fitted_layers(asked, 1, LayerFit::growth, 1.1).growth, 1.2) << "never less";
  layers::WallLayers enough = asked;
  enough.count = 60;
  const layers::WallLayers higher = fitted_layers(enough, 1, LayerFit::growth, 1.3);
  EXPECT_EQ(higher.growth, 1.2) << "the total alone ended them";
  EXPECT_EQ(change_of_fit(enough, higher, 1), "no limit to their height, so that 38 layers end isotropic");
  layers::WallLayers high = asked;
  high.count = 0;
  const std::int32_t held = layers::wanted_count(high, 1);
  EXPECT_EQ(fitted_layers(high, 1, LayerFit::growth, 2).count, held);
}

TEST(FittedLayers, GrowAtMostByTheMaximum) {
  const layers::WallLayers asked{.first = 1e-3, .growth = 1.2, .constant = 2, .count = 10, .total = 0};
  const layers::WallLayers fitted = fitted_layers(asked, 1, LayerFit::growth, 1.3);
  EXPECT_EQ(fitted.growth, 1.3);
  EXPECT_NE(early_end(fitted, 1), "");
  EXPECT_EQ(change_of_fit(asked, fitted, 1), "growth 1.3 for 1.2, as much as 'layers.growth_maximum' allows");
  layers::WallLayers level = asked;
  level.constant = 10;
  EXPECT_EQ(change_of_fit(level, fitted_layers(level, 1, LayerFit::growth, 1.3), 1), "") << "none grows";
}

TEST(FittedLayers, GoOnWithoutCountAndTotal) {
  const layers::WallLayers asked{.first = 1e-3, .growth = 1.2, .constant = 2, .count = 10, .total = 0.5};
  const layers::WallLayers fitted = fitted_layers(asked, 1, LayerFit::count, 1.3);
  EXPECT_EQ(fitted.growth, 1.2);
  EXPECT_EQ(fitted.count, 0);
  EXPECT_EQ(fitted.total, 0);
  EXPECT_EQ(change_of_fit(asked, fitted, 1), "38 layers for 10, so that they end isotropic");
  layers::WallLayers level = asked;
  level.growth = 1;
  EXPECT_EQ(fitted_layers(level, 1, LayerFit::count, 1.3).count, 10) << "nothing would end them";
}

TEST(FittedLayers, StayWhereNotAskedForOrWhereTheyMeetTheSizes) {
  const layers::WallLayers asked{.first = 1e-3, .growth = 1.2, .constant = 2, .count = 10, .total = 0};
  EXPECT_EQ(change_of_fit(asked, fitted_layers(asked, 1, LayerFit::none, 1.3), 1), "");
  for (const LayerFit fit : {LayerFit::growth, LayerFit::count})
    EXPECT_EQ(change_of_fit(asked, fitted_layers(asked, 0.005, fit, 1.3), 0.005), "") << "small edges";
}

// Sums of heights stay about the same, so that a family of meshes resolves the same part of the flow.
TEST_F(LayerKeys, TakeTheScaleOfTheSizes) {
  const std::string asked =
      "first: 1e-3, growth: 1.21, constant: 4, count: 12, total: 0.5, patches: {fan: {growth: 1.21, count: "
      "1}}";
  const layers::LayerOptions fine = options_of(with_layers(asked, "sizing: {scale: 0.5}\n"));
  EXPECT_EQ(fine.patches[0].first, 0.5e-3);
  EXPECT_NEAR(fine.patches[0].growth, 1.1, 1e-12);
  EXPECT_EQ(fine.patches[0].constant, 8);
  EXPECT_EQ(fine.patches[0].count, 24);
  EXPECT_EQ(fine.patches[0].total, 0.5);
  EXPECT_NEAR(fine.patches[1].growth, 1.1, 1e-12);
  EXPECT_EQ(fine.patches[1].count, 2);
  EXPECT_EQ(fine.patches[2].first, 0) << "no wall";
  const layers::LayerOptions coarse = options_of(with_layers(asked, "sizing: {scale: 2}\n"));
  EXPECT_EQ(coarse.patches[0].constant, 2);
  EXPECT_EQ(coarse.patches[0].count, 6);
  EXPECT_EQ(coarse.patches[1].count, 1) << "at least one";
  const layers::WallLayers until =
      options_of(with_layers("first: 1e-3", "sizing: {scale: 0.5}\n")).patches[0];
  EXPECT_EQ(until.count, 0) << "as many as it takes";
  const auto height = [](const layers::WallLayers& wall) {
    return layers::Heights{wall.first, wall.growth, wall.constant}.total(wall.count);
  };
  const double as_asked = height(options_of(with_layers(asked)).patches[0]);
  EXPECT_NEAR(height(fine.patches[0]) / as_asked, 1, 0.1);
  EXPECT_NEAR(height(coarse.patches[0]) / as_asked, 1, 0.1);
}

/// The workshops' tables: HLPW-3 medium and DPW-8's at 5 and 30 million, within 3 %.
TEST_F(LayerKeys, HeightsFromTheFlowAreThoseOfTheWorkshops) {
  using sizing::SolverPoints;
  EXPECT_NEAR(first_height(0.67, 3.26e6, 275.8, SolverPoints::vertex) / 0.00117, 1, 0.03);
  EXPECT_NEAR(first_height(1, 1.9e6, 529, SolverPoints::vertex) / 0.00545, 1, 0.03);
  EXPECT_EQ(first_height(1, 1e6, 1, SolverPoints::cell), 2 * first_height(1, 1e6, 1, SolverPoints::vertex));
}

TEST_F(LayerKeys, LevelsHaveYPlusGrowthAndConstantLayers) {
  const Case input = with_layers("reynolds: 5e6, length: 7", "sizing: {level: fine, family: dpw}\n");
  const layers::WallLayers wall = options_of(input).patches[0];
  EXPECT_EQ(wall.first, first_height(0.4, 5e6, 7, sizing::SolverPoints::vertex));
  EXPECT_EQ(wall.growth, 1.045);
  EXPECT_EQ(wall.constant, 5);
  const Case given =
      with_layers("reynolds: 5e6, length: 7, y_plus: 1, growth: 1.2, constant: 1", "sizing: {level: fine}\n");
  EXPECT_EQ(options_of(given).patches[0].growth, 1.2);
  EXPECT_EQ(options_of(given).patches[0].constant, 1);
  EXPECT_EQ(options_of(given).patches[0].first, first_height(1, 5e6, 7, sizing::SolverPoints::vertex));
}

TEST_F(LayerKeys, HeightsMayBeThoseOfTheLevel) {
  const std::string level = "sizing: {level: C, solver: cell}\n";
  const Case input = with_layers("first: level, reynolds: 5e6, length: 7", level);
  const layers::WallLayers wall = options_of(input).patches[0];
  EXPECT_EQ(wall.first, first_height(1, 5e6, 7, sizing::SolverPoints::cell)) << "y+ of the centre";
  EXPECT_NEAR(y_plus_of(wall.first, 5e6, 7), 2, 1e-12) << "of the node";
  EXPECT_EQ(wall.growth, 1.1);
  EXPECT_EQ(wall.constant, 2) << "no level with a letter says how many";
  const Case again = case_of_resolved(resolved_yaml(input));
  EXPECT_TRUE(again.layers.first_of_level);
  EXPECT_FALSE(again.layers.first);
  EXPECT_EQ(options_of(again).patches[0].first, wall.first);
}

TEST_F(LayerKeys, SayWhatIsMissing) {
  const auto expect = [&](const std::string& layers, const std::string& text) {
    EXPECT_NE(refused(layers).find(text), std::string::npos) << refused(layers);
  };
  expect("growth: 1.2", "case.yaml:2:1: 'layers' needs the height of the first layer: 'first', or");
  expect("first: 1e-5, y_plus: 1, reynolds: 1e6, length: 1", "'layers.first' and 'layers.y_plus' exclude");
  expect("y_plus: 1", "'layers.reynolds' and 'layers.length' are needed");
  expect("y_plus: 1, reynolds: 1e6", "'layers.reynolds' and 'layers.length' are needed");
  expect("reynolds: 1e6, length: 1", "needs 'layers.y_plus', or 'sizing.level'");
  expect("first: level, reynolds: 1e6, length: 1", "'layers.first: level' needs 'sizing.level'");
  expect("first: level, y_plus: 1", "'layers.first: level' and 'layers.y_plus' exclude");
  expect("first: levl", "expected a number or 'level', got 'levl'");
  expect("fit: growth", "'layers' needs the height of the first layer");
  expect("first: 1, fit: height", "growth");
  expect("gate: {full_area: 0.9}", "'layers' needs the height of the first layer");
  expect("first: 1, gate: {full_area: 2}", "at most 1");
  expect("walls: none", "needed below 'layers.patches'");
  expect("walls: none, patches: {wing: {growth: 1.1}}", "'layers.patches.wing' needs 'first'");
  expect("first: 0", "above 0");
  expect("first: 1, growth: 0.9", "at least 1 and at most 2");
  expect("first: 1, until: forever", "isotropic");
  expect("first: 1, growth: 1", "case.yaml:2:20: 'layers.growth' is 1, and neither 'count' nor 'total'");
  expect("first: 0.01, total: 0.001",
         "case.yaml:2:23: 'layers.total' is 0.001, less than the height of the first layer, 0.01");
  const std::string of_level = transport + "sizing: {level: C}\nlayers: {first: level, length: 1}\n";
  EXPECT_NE(error_of(of_level).find("'layers.reynolds' and 'layers.length' are needed"), std::string::npos)
      << error_of(of_level);
}

TEST_F(LayerKeys, HeightsOfPatchesHaveRoomAndAnEnd) {
  const auto expect = [&](const std::string& layers, const std::string& text) {
    EXPECT_NE(refused(layers).find(text), std::string::npos) << layers << "\n" << refused(layers);
  };
  expect("first: 1, total: 2, patches: {wing: {growth: 1.2, first: 3}}",
         "'layers.total' is 2, less than the height of the first layer on patch 'wing', 3");
  expect("first: 1, patches: {wing: {total: 0.5}}", "'layers.patches.wing.total' is 0.5, less than");
  expect("first: 1, patches: {wing: {growth: 1}}", "'layers.patches.wing.growth' is 1, and neither");
  expect("reynolds: 1e3, length: 10, y_plus: 1, total: 1e-5", "'layers.total' is 1e-05, less than");
  expect("walls: none, growth: 1, patches: {wing: {first: 1}}", "'layers.growth' is 1, and neither");
  EXPECT_EQ(refused("first: 1, growth: 1, count: 4, total: 1"), "no error");
  EXPECT_EQ(refused("first: 1, growth: 1, total: 1, patches: {wing: {first: 5, count: 0}}"), "no error");
  EXPECT_EQ(refused("walls: none, growth: 1, patches: {wing: {first: 1, growth: 1.1}}"), "no error");
}

}  // namespace
}  // namespace aeroloom::cases
