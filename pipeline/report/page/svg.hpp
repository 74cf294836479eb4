/// Charts of a page as SVG, in the colours of the style sheet.
#pragma once

#include "pipeline/report/page/html_text.hpp"

#include <string>
#include <vector>

namespace aeroloom::page {

/// A vertical line in a chart.
struct Mark {
  double at = 0;
  std::string label;   ///< plain text
  bool limit = false;  ///< marks the bars on its bad side
};

/// A histogram with a logarithmic scale, which shows single elements among millions.
struct HistogramChart {
  std::string title;          ///< plain text
  std::string unit;           ///< printed after numbers of the axis
  double tick = 10;           ///< distance between numbers of the axis
  double from = 0, to = 180;  ///< the axis shows at least this range
  bool small_is_bad = true;
  std::vector<Mark> marks;
};

/// `histogram`: {low, high, counts} of report.json; empty without counts.
std::string histogram_chart(const Json& histogram, const HistogramChart& chart);

/// A small histogram for a table cell, bars only.
std::string small_histogram(const Json& counts);

/// One horizontal bar for each rank, divided by stages: [rank][stage] seconds.
std::string load_chart(const std::vector<std::string>& stages,
                       const std::vector<std::vector<double>>& seconds);

}  // namespace aeroloom::page
