#include "pipeline/case/layer_gate.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

using layers::LayerLimit;

const std::vector<std::string> patches{"wing", "farfield", "nacelle"};

/// A wing with nine tenths of its area covered, and a small nacelle with half, for want of room.
class LayerGates : public ::testing::Test {
protected:
  LayerGates() {
    asked.patches.resize(3);
    asked.patches[0].first = asked.patches[2].first = 1e-3;
    report.patches.resize(3);
    layers::PatchLayers &wing = report.patches[0], &nacelle = report.patches[2];
    wing.area = 10, wing.full_area = 9, wing.partial_area = 1;
    nacelle.area = 4, nacelle.full_area = 2, nacelle.empty_area = 2;
    limit(wing, LayerLimit::slope) = 1;
    limit(nacelle, LayerLimit::gap) = 1.5, limit(nacelle, LayerLimit::validity) = 0.5;
    report.patches[1].area = 1000;  // not asked for
  }
  static double& limit(layers::PatchLayers& patch, LayerLimit cause) {
    return patch.limited_area[static_cast<std::size_t>(cause)];
  }
  std::string missed(double full_area) const {
    return missed_limits({true, full_area}, asked, report, patches);
  }

  layers::LayerOptions asked;
  layers::LayerReport report;
};

TEST_F(LayerGates, CompareTheAreaOfWallsThatAskForLayers) {
  const std::vector<GateLimit> limits = compare_with_gate({true, 0.8}, asked, report);
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_EQ(limits[0].key, "layers.gate.full_area");
  EXPECT_DOUBLE_EQ(limits[0].value, 11.0 / 14);
  EXPECT_FALSE(limits[0].met());
  EXPECT_TRUE(compare_with_gate({}, asked, report).empty());
}

TEST_F(LayerGates, NameThePatchesThatLackMostAndWhy) {
  const std::string text = missed(0.8);
  EXPECT_NE(text.find("layers.gate.full_area is 0.7857, not 0.8 at least"), std::string::npos) << text;
  const std::size_t nacelle = text.find(
                        "patch 'nacelle' lacks layers on 50 % of its area, and has none on 50 %, "
                        "mostly for walls too near opposite and cells that would be bad"),
                    wing = text.find("patch 'wing' lacks layers on 10 %");
  EXPECT_LT(nacelle, wing) << text;
  EXPECT_NE(wing, std::string::npos) << text;
  EXPECT_EQ(text.find("farfield"), std::string::npos) << text;
}

TEST_F(LayerGates, AreMetWhereThereIsAsMuch) {
  EXPECT_EQ(missed(0.78), "");
  EXPECT_EQ(missed_limits({}, asked, report, patches), "");
}

TEST_F(LayerGates, AreMissedWhereNoWallAsks) {
  asked.patches.assign(3, {});
  EXPECT_NE(missed(0.5).find("no wall asks for layers"), std::string::npos);
}

TEST_F(LayerGates, WarnOfWallsWithoutAny) {
  report.patches[0].most_layers = report.patches[2].most_layers = 7;
  EXPECT_EQ(missing_layers(asked, report, patches), "");
  report.patches[2].most_layers = 0;
  const std::string text = missing_layers(asked, report, patches);
  EXPECT_EQ(text.find("1 of 2 walls that ask for layers have none at all ('nacelle'), mostly for walls too "
                      "near opposite"),
            0u)
      << text;
  asked.patches.assign(3, {});
  EXPECT_NE(missing_layers(asked, report, patches).find("no wall is there"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
