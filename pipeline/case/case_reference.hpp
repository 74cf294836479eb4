/// The reference of the keys of a case, for docs/configuration.md.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// Markdown: a heading, the text and a table for each section; links are relative to docs/. Begins and ends
/// with comments that mark it.
std::string case_reference(const std::vector<KeyInfo>& keys);

/// The page with the marked part replaced by the reference. Throws std::invalid_argument where the page has
/// no such part.
std::string with_reference(const std::string& page, const std::string& reference);

}  // namespace aeroloom::cases
