/// What stands in a page, for its tests.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::page {

inline int occurrences(std::string_view text, std::string_view words) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string_view::npos; at = text.find(words, at + 1))
    ++count;
  return count;
}

/// The numbers of an attribute of all elements of a class, in their order.
inline std::vector<double> attribute(const std::string& text, const std::string& kind,
                                     const std::string& name) {
  std::vector<double> values;
  const std::string element = "class=\"" + kind + "\"", before = " " + name + "=\"";
  for (std::size_t at = text.find(element); at != std::string::npos; at = text.find(element, at + 1))
    values.push_back(std::stod(text.substr(text.find(before, at) + before.size())));
  return values;
}

}  // namespace aeroloom::page
