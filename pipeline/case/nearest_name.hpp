/// The name a user probably meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other (optimal
/// string alignment; Damerau, Comm. ACM 7, 1964, doi:10.1145/363958.363994).
int edit_distance(const std::string& a, const std::string& b);

/// The candidate nearest to `word`, the first of several; none where even that one differs in more than a
/// third of the word's characters and does not begin with the word.
std::optional<std::string> nearest_name(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace aeroloom::cases
