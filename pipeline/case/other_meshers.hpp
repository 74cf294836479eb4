/// What users of other meshers look for in a case: the key that does it here, or that it is out of scope.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace aeroloom::cases {

/// Words for one thing, as keys or values of other meshers have them, with the answer.
struct OtherWords {
  std::string_view topic;   ///< as docs/out_of_scope.md has it
  std::string_view answer;  ///< a clause: "the key is 'sizing.maximum'"
  std::string_view words;   ///< parted by blanks; lower case, without marks
};

/// The page that says more.
inline constexpr std::string_view page_of_other_words = "docs/out_of_scope.md";

/// What this program does not do.
std::span<const OtherWords> out_of_scope();
/// What it does, under another key.
std::span<const OtherWords> named_otherwise();
/// The same for keys that another section has; words are whole paths.
std::span<const OtherWords> paths_otherwise();
/// Values of its keys that others name otherwise.
std::span<const OtherWords> values_otherwise();

/// The answer to a key that no case has, whatever its capitals, underscores, hyphens and blanks; of a name
/// with dots or slashes the last part counts. Empty if the word is not known.
std::optional<std::string> answer_to_key(const std::string& key);
/// The answer to a key by its whole path, "geometry.scale".
std::optional<std::string> answer_to_path(const std::string& path);
/// The same as answer_to_key() for a value that its key does not accept.
std::optional<std::string> answer_to_value(const std::string& value);

/// Throws CaseError, with advice, if the name says that the file is a geometry.
void require_no_geometry(const std::string& file);
/// The same for settings of another mesher, by the name or the text of the file.
void require_no_settings(const std::string& file, const std::string& text);

}  // namespace aeroloom::cases
