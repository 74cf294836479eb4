#include "pipeline/shown_changes.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {

std::vector<std::string> shown_changes(cad::Changes changes, const std::string& all_of_them) {
  constexpr std::size_t most = 5, of_many = 3;  // lines of the log; the report has all
  const std::size_t shown = changes.size() <= most ? changes.size() : of_many;
  if (shown < changes.size()) {
    std::stable_sort(changes.begin(), changes.end(),
                     [](const cad::Change& a, const cad::Change& b) { return a.how_much > b.how_much; });
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(cad::describe(changes[i]));
  if (shown < changes.size())
    lines.push_back(fmt::format("{} more, which moved less, are in {}", changes.size() - shown, all_of_them));
  return lines;
}

}  // namespace aeroloom::pipeline
