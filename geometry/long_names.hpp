/// Names that files give: how long they may be.
#pragma once

#include <cstddef>
#include <string>

namespace aeroloom::geometry {

/// Bytes of a name that are read. Longer ones are no names that anyone reads, and every file of the output
/// would repeat them.
inline constexpr std::size_t longest_name = 4096;

/// Cuts a name that is longer to `longest_name` bytes, between two characters of UTF-8; true if it did. The
/// last bytes are then a sign made of the whole name, so that two names do not become one.
bool cut_long_name(std::string& name);

/// What is said of names that were cut; `names` are how many.
std::string long_names_text(std::size_t names);

}  // namespace aeroloom::geometry
