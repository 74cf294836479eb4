#include "pipeline/report/page/line_chart.hpp"
#include "pipeline/report/page/style.hpp"
#include "pipeline/report/page/svg.hpp"
#include "tests/pipeline/report/page/occurrences.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::page {
namespace {

/// Angles from 0 to 180 degrees in bins of 45.
Json angles(const std::vector<int>& counts) {
  return {{"low", 0}, {"high", 180}, {"counts", counts}};
}

HistogramChart angles_chart() {
  HistogramChart chart;
  chart.title = "angles <all>";
  chart.unit = "°";
  return chart;
}

TEST(Histogram, HasABarForEachBinThatHoldsAnything) {
  const std::string chart = histogram_chart(angles({1, 0, 1000, 30}), angles_chart());
  const std::vector<double> heights = attribute(chart, "count", "height");
  ASSERT_EQ(heights.size(), 3u);
  EXPECT_GT(heights[0], 5) << "a single one is seen beside a thousand";
  EXPECT_LT(heights[0], heights[2]);
  EXPECT_LT(heights[2], heights[1]);
  EXPECT_EQ(occurrences(chart, "<title>0° to 45°: 1 tetrahedron</title>"), 1);
  EXPECT_EQ(occurrences(chart, "<title>90° to 135°: 1,000 tetrahedra</title>"), 1);
  EXPECT_EQ(occurrences(chart, "angles &lt;all&gt;"), 2);
}

TEST(Histogram, MarksBarsBeyondALimit) {
  HistogramChart chart = angles_chart();
  chart.marks = {{45, "limit", true}, {170, "target", false}, {200, "outside", false}};
  const Json histogram = angles({1, 2, 3, 4});
  EXPECT_EQ(occurrences(histogram_chart(histogram, chart), "class=\"beyond\""), 1);
  EXPECT_EQ(occurrences(histogram_chart(histogram, chart), "class=\"mark\""), 2);
  EXPECT_EQ(occurrences(histogram_chart(histogram, chart), "outside"), 0);
  chart.small_is_bad = false;
  EXPECT_EQ(occurrences(histogram_chart(histogram, chart), "class=\"beyond\""), 3);
}

TEST(Histogram, IsNotThereWithoutCounts) {
  EXPECT_EQ(histogram_chart({}, {}), "");
  EXPECT_EQ(histogram_chart(angles({0, 0}), {}), "");
  EXPECT_EQ(histogram_chart({{"low", 3}, {"high", 3}, {"counts", {1}}}, {}), "");
}

TEST(Histogram, SmallOnesHaveHeightsAlone) {
  EXPECT_EQ(attribute(small_histogram({5, 10, 0}), "count", "height"), (std::vector<double>{10, 20, 0}));
}

TEST(LoadChart, BarsAreAsLongAsTheirSeconds) {
  const std::string chart = load_chart({"surface", "volume", "improve"}, {{1, 3, 0}, {2, 0, 0}});
  const std::vector<double> surface = attribute(chart, "stage0", "width");
  ASSERT_EQ(surface.size(), 3u) << "two ranks and the legend";
  const std::vector<double> volume = attribute(chart, "stage1", "width");
  ASSERT_EQ(volume.size(), 2u);
  EXPECT_NEAR(volume[0], 3 * surface[0], 0.2);
  EXPECT_NEAR(surface[1], 2 * surface[0], 0.2);
  EXPECT_EQ(occurrences(chart, "improve"), 0) << "no second went into it";
  EXPECT_EQ(load_chart({"surface"}, {{0}, {0}}), "");
}

TEST(LineChart, HasAMarkerAtEachPointAndAShapeForEachLine) {
  const std::string chart =
      line_chart({{"wing & body", {{1, 10}, {2, 5}, {4, 2.5}}},
                  {"other", {{1, 8}, {4, 4}}},
                  {"ideal", {{1, 10}, {4, 2.5}}, true}},
                 {.title = "time", .x_name = "ranks", .y_name = "s", .logarithmic = true});
  EXPECT_EQ(occurrences(chart, "<title>wing &amp; body, "), 3);
  EXPECT_EQ(attribute(chart, "line0", "cx").size(), 4u) << "three points and the legend";
  EXPECT_EQ(attribute(chart, "line1", "width").size(), 3u);
  EXPECT_EQ(occurrences(chart, "<title>ideal"), 0);
  // Halving the time with each doubling is a straight line of both axes.
  const std::vector<double> x = attribute(chart, "line0", "cx"), y = attribute(chart, "line0", "cy");
  EXPECT_NEAR(x[2] - x[1], x[1] - x[0], 0.2);
  EXPECT_NEAR(y[2] - y[1], y[1] - y[0], 0.2);
  EXPECT_GT(y[1], y[0]) << "down the page";
}

TEST(LineChart, JoinsNoPointsOfTwoKinds) {
  const ChartLine line{
      "by the clock", {{1, 1}, {2, 2}, {4, 3}, {8, 4}}, false, {false, false, true, true}, "by CPU"};
  const std::string chart = line_chart({line}, {.title = "kinds", .x_name = "ranks", .y_name = ""});
  const std::size_t path = chart.find("<path class=\"stroke0\" d=\"");
  ASSERT_NE(path, std::string::npos);
  const std::string drawn = chart.substr(path, chart.find("/>", path) - path);
  EXPECT_EQ(occurrences(drawn, "M"), 2);
  EXPECT_EQ(occurrences(drawn, "L"), 2);
  EXPECT_EQ(occurrences(chart, "<circle class=\"hollow stroke0\""), 3) << "two points, and the legend";
  EXPECT_EQ(occurrences(chart, "<title>by CPU, 8: 4</title>"), 1);
  EXPECT_EQ(occurrences(chart, "</svg>by CPU</li>"), 1);
}

TEST(LineChart, FractionsArePercent) {
  LineChart of_fractions;
  of_fractions.percent = true;
  const std::string chart = line_chart({{"efficiency", {{1, 1}, {2, 0.5}}}}, of_fractions);
  EXPECT_EQ(occurrences(chart, "<title>efficiency, 2: 50 %</title>"), 1);
  EXPECT_EQ(occurrences(chart, ">100 %</text>"), 1);
  EXPECT_EQ(line_chart({{"nothing", {}}}, {}), "");
}

TEST(PileChart, PartsStandOnEachOther) {
  const std::string chart =
      stacked_bar_chart("memory", " GiB", {"mesh", "field"}, {{"1 rank", {2, 1}}, {"2 ranks", {1, 0}}});
  const std::vector<double> mesh = attribute(chart, "stage0", "height"),
                            field = attribute(chart, "stage1", "height");
  ASSERT_EQ(mesh.size(), 2u);
  ASSERT_EQ(field.size(), 1u) << "a part of nothing is not drawn";
  EXPECT_NEAR(mesh[0], 2 * mesh[1], 0.2);
  const double below = attribute(chart, "stage0", "y")[0];
  EXPECT_NEAR(attribute(chart, "stage1", "y")[0] + field[0], below, 0.2);
  EXPECT_EQ(stacked_bar_chart("memory", "", {"mesh"}, {{"1 rank", {0}}}), "");
}

TEST(Style, NamesNothingOutsideThePage) {
  EXPECT_EQ(occurrences(style_sheet(), "url("), 0);
  EXPECT_EQ(occurrences(style_sheet(), "@import"), 0);
  EXPECT_EQ(occurrences(style_sheet(), "{"), occurrences(style_sheet(), "}"));
}

}  // namespace
}  // namespace aeroloom::page
