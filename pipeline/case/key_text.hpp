/// What is told of a key, in words: shared by the reference, the schema and the template.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// Markdown without links: the name of the page stands there instead.
std::string without_links(const std::string& markdown);
/// What the key accepts: "number above 1 and at most 3". Empty for sections.
std::string accepted_values(const KeyInfo& key);
/// What holds where the key is not given: its default, or "from the model". Empty where there is nothing to
/// tell.
std::string value_left_out(const KeyInfo& key);
/// The text as lines of at most `width` characters, broken at spaces; longer words stay whole.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

}  // namespace aeroloom::cases
