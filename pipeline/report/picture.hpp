/// A picture of the report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::report {

/// A colour of a picture and what it stands for.
struct LegendItem {
  std::string name;
  std::string colour;  ///< as HTML writes it: "#rrggbb"
};

struct Picture {
  std::string name;     ///< of a file without its extension: letters, digits, underscores
  std::string caption;  ///< what is to be seen, a sentence
  int width = 0, height = 0;
  std::vector<std::uint8_t> png{};
  std::vector<LegendItem> legend{};
};

}  // namespace aeroloom::report
