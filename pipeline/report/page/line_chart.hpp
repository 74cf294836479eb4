/// Charts of scaling studies as SVG, readable without colours.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::page {

/// One line, with markers and its own dash pattern.
struct ChartLine {
  std::string name;  ///< plain text
  std::vector<std::pair<double, double>> points;
  bool ideal = false;  ///< a reference line: thin, without markers
  /// By point: of another kind, with a hollow marker; points of two kinds are not joined. Empty: of one kind.
  std::vector<bool> other_kind = {};
  std::string other_name = {};  ///< of the other kind, plain text
};

struct LineChart {
  std::string title, x_name, y_name;  ///< plain text
  bool logarithmic = false;           ///< both axes; else only x is logarithmic
  bool percent = false;               ///< y values are fractions
  double y_least = 0;                 ///< lower end of a linear y axis
};

/// Empty if no line has a point.
std::string line_chart(const std::vector<ChartLine>& lines, const LineChart& chart);

/// A stacked bar with its name below. The lowest segment has the number 0.
struct StackedBar {
  std::string name;           ///< plain text
  std::vector<double> parts;  ///< one for each name of a segment
};
std::string stacked_bar_chart(const std::string& title, const std::string& unit,
                              const std::vector<std::string>& parts, const std::vector<StackedBar>& bars);

}  // namespace aeroloom::page
