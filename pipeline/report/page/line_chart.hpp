/// Charts over numbers of ranks, drawn as SVG that can be distinguished without colours.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::page {

/// One line: a marker at each point, and a dash of its own.
struct ChartLine {
  std::string name;  ///< plain text
  std::vector<std::pair<double, double>> points;
  bool ideal = false;  ///< thin and without markers: what would be best
};

struct LineChart {
  std::string title, x_name, y_name;  ///< plain text
  bool logarithmic = false;           ///< both axes; x is so always
  bool percent = false;               ///< numbers of y are fractions
  double y_least = 0;                 ///< where y begins, of a linear axis
};

/// Nothing where no line has a point.
std::string line_chart(const std::vector<ChartLine>& lines, const LineChart& chart);

/// A pile of parts beside another, each with its name below; parts below the first have the number 0.
struct Pile {
  std::string name;           ///< plain text
  std::vector<double> parts;  ///< as many as there are names of parts
};
std::string pile_chart(const std::string& title, const std::string& unit,
                       const std::vector<std::string>& parts, const std::vector<Pile>& piles);

}  // namespace aeroloom::page
