/// A picture of the report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::report {

/// A colour in a picture and its meaning.
struct LegendItem {
  std::string name;
  std::string colour;  ///< as in HTML: "#rrggbb"
};

struct Picture {
  std::string name;     ///< file name without extension: letters, digits, underscores
  std::string caption;  ///< one sentence
  int width = 0, height = 0;
  std::vector<std::uint8_t> png{};
  std::vector<LegendItem> legend{};
};

}  // namespace aeroloom::report
