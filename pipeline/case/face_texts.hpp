/// Parses colours and face numbers from texts of a case.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::cases {

/// First and last face number.
struct NumberRange {
  std::int32_t first = 0, last = -1;
};

/// "#rrggbb" in lower case from "#RRGGBB" or "#RGB", with or without #. Empty if `text` is neither.
std::optional<std::string> plain_color(const std::string& text);
/// From "3" or "17-20". Empty if `text` is neither.
std::optional<NumberRange> number_range(const std::string& text);

}  // namespace aeroloom::cases
