/// Writes the reference of all keys: the pages of docs/configuration/.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// A page of the reference.
struct ReferencePage {
  std::string file;  ///< file name in docs/configuration/
  std::string title;
  std::string keys;  ///< Markdown between two marking comments
};

/// README.md with the list of sections, and SECTION.md for each top section, with texts and tables of its
/// keys. Links are relative to docs/configuration/.
std::vector<ReferencePage> case_reference(const std::vector<KeyInfo>& keys);

/// A page with only its title and keys.
std::string new_page(const ReferencePage& page);

/// `text` with the marked part replaced by the keys. Throws std::invalid_argument if it has no marked part.
std::string with_reference(const std::string& text, const std::string& keys);

}  // namespace aeroloom::cases
