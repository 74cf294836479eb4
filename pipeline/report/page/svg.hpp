/// Charts of a page, drawn as SVG. Colours are those of the style sheet.
#pragma once

#include "pipeline/report/page/html_text.hpp"

#include <string>
#include <vector>

namespace aeroloom::page {

/// A vertical line in a chart.
struct Mark {
  double at = 0;
  std::string label;   ///< plain text
  bool limit = false;  ///< bars on its bad side are marked
};

/// A histogram with a logarithmic scale, so that single elements in a tail of a million are seen.
struct HistogramChart {
  std::string title;          ///< plain text
  std::string unit;           ///< after numbers of the axis
  double tick = 10;           ///< distance of the numbers on the axis
  double from = 0, to = 180;  ///< the part of the axis that is always shown; more where there are counts
  bool small_is_bad = true;
  std::vector<Mark> marks;
};

/// `histogram` is {low, high, counts} of report.json; nothing where there are no counts.
std::string histogram_chart(const Json& histogram, const HistogramChart& chart);

/// A small histogram for a cell of a table, of heights alone.
std::string small_histogram(const Json& counts);

/// Bars of the ranks, one below the other, in sections one per stage: [rank][stage] seconds.
std::string load_chart(const std::vector<std::string>& stages,
                       const std::vector<std::vector<double>>& seconds);

}  // namespace aeroloom::page
