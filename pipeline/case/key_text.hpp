/// Describes keys in words, for the reference, the schema and the template.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// Markdown with each link replaced by the name of its page.
std::string without_links(const std::string& markdown);
/// Accepted values: "number above 1 and at most 3". Empty for sections.
std::string accepted_values(const KeyInfo& key);
/// What holds without the key: its default, or "from the model". May be empty.
std::string value_left_out(const KeyInfo& key);
/// The text in lines of at most `width` characters, broken at spaces. Longer words stay whole.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

}  // namespace aeroloom::cases
