#include "pipeline/case/key_text.hpp"

#include <cmath>
#include <regex>
#include <sstream>

#include <fmt/format.h>

namespace aeroloom::cases {

std::string without_links(const std::string& markdown) {
  static const std::regex to_page(R"(\(\[[^\]]*\]\(([^)#]*)\)\))");
  static const std::regex to_heading(R"(\(\[([^\]]*)\]\(([^)#]*)#[^)]*\)\))");
  static const std::regex in_text(R"(\[([^\]]*)\]\(([^)#]*)(#[^)]*)?\))");
  const std::string once = std::regex_replace(markdown, to_page, "(docs/$1)");
  const std::string twice = std::regex_replace(once, to_heading, "(docs/$2: $1)");
  return std::regex_replace(twice, in_text, "$1 (docs/$2)");
}

namespace {

std::string numbers_within(const Range& range) {
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  std::string text;
  if (low && range.low_allowed && high) {
    text = fmt::format("from {} to {}", shortest(range.low), shortest(range.high));
  } else {
    if (low) text = fmt::format("{} {}", range.low_allowed ? "at least" : "above", shortest(range.low));
    if (high) text += fmt::format("{}at most {}", low ? ", " : "", shortest(range.high));
  }
  if (range.unit.empty()) return text;
  if (!text.empty()) return text + " " + range.unit;
  return range.unit[0] == '(' ? range.unit : fmt::format("({})", range.unit);
}

/// With a space between them, unless there is no second word.
std::string two_words(const std::string& first, const std::string& second) {
  return second.empty() ? first : first + " " + second;
}

}  // namespace

std::string accepted_values(const KeyInfo& key) {
  switch (key.kind) {
    case KeyKind::number:
      return two_words("number", numbers_within(key.range)) +
             (key.choices.empty() ? "" : ", or " + joined(key.choices));
    case KeyKind::integer:
      return two_words("whole number", numbers_within(key.range));
    case KeyKind::flag:
      return "true or false";
    case KeyKind::text:
      return "text";
    case KeyKind::texts:
      return "list of texts, or one text";
    case KeyKind::choice:
      return (key.choices.size() > 1 ? "one of " : "") + joined(key.choices);
    case KeyKind::choices:
      return "one or a list of " + joined(key.choices);
    case KeyKind::point:
      return "list of three numbers (length unit of the geometry)";
    case KeyKind::direction:
      return "list of three numbers (direction)";
    case KeyKind::interval:
      return two_words("list of two numbers, the smaller one first", key.range.unit);
    case KeyKind::box:
      return "list of two points (opposite corners, length unit of the geometry)";
    case KeyKind::sections:
      return "list of selections";
    case KeyKind::section:
    case KeyKind::named:
      break;
  }
  return "";
}

std::string value_left_out(const KeyInfo& key) {
  if (key.default_value.empty()) return key.doc.left_out;
  return key.default_value + (key.doc.left_out.empty() ? "" : ": " + key.doc.left_out);
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (lines.empty() || lines.back().size() + 1 + word.size() > width) {
      lines.push_back(word);
    } else {
      lines.back() += " " + word;
    }
  }
  return lines;
}

}  // namespace aeroloom::cases
