/// The reference of the keys of a case: the pages of docs/configuration/.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// A page of the reference.
struct ReferencePage {
  std::string file;  ///< its name in the folder of the pages
  std::string title;
  std::string keys;  ///< Markdown; begins and ends with comments that mark it
};

/// The list of sections, README.md, and a page for each section of the first level, SECTION.md: texts, and a
/// table of the keys of each section. Links are relative to the folder of the pages, docs/configuration/.
std::vector<ReferencePage> case_reference(const std::vector<KeyInfo>& keys);

/// A page with nothing but its title and its keys.
std::string new_page(const ReferencePage& page);

/// The text of a page with the marked part replaced by the keys. Throws std::invalid_argument where the text
/// has no such part.
std::string with_reference(const std::string& text, const std::string& keys);

}  // namespace aeroloom::cases
