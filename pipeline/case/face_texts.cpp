#include "pipeline/case/face_texts.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace aeroloom::cases {

std::optional<std::string> plain_color(const std::string& text) {
  std::string digits = text.starts_with("#") ? text.substr(1) : text;
  std::transform(digits.begin(), digits.end(), digits.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const bool hexadecimal =
      std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!hexadecimal) return std::nullopt;
  constexpr std::size_t of_short = 3, of_long = 6;
  if (digits.size() == of_short) {
    std::string both;
    for (const char digit : digits) both.append(2, digit);
    digits = both;
  }
  return digits.size() == of_long ? std::optional("#" + digits) : std::nullopt;
}

std::optional<NumberRange> number_range(const std::string& text) {
  NumberRange range;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, range.first);
  if (error != std::errc{} || range.first < 0) return std::nullopt;
  if (after == end) return NumberRange{range.first, range.first};
  if (*after != '-' || after + 1 == end || *(after + 1) == '-') return std::nullopt;
  const auto [last, wrong] = std::from_chars(after + 1, end, range.last);
  if (wrong != std::errc{} || last != end || range.last < range.first) return std::nullopt;
  return range;
}

}  // namespace aeroloom::cases
