/// Texts that stand for colours and for numbers of faces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::cases {

/// Numbers of faces, both included.
struct NumberRange {
  std::int32_t first = 0, last = -1;
};

/// "#rrggbb" in small letters of "#RRGGBB" or "#RGB", with or without #; none of anything else.
std::optional<std::string> plain_color(const std::string& text);
/// Of "3" or "17-20"; none of anything else.
std::optional<NumberRange> number_range(const std::string& text);

}  // namespace aeroloom::cases
