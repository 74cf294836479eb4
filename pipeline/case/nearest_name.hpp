/// Finds the name that a user probably meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Insertions, deletions, replacements and swaps of adjacent letters between two words (optimal string
/// alignment; Damerau, Comm. ACM 7, 1964, doi:10.1145/363958.363994).
int edit_distance(const std::string& a, const std::string& b);

/// The candidate nearest to `word`; the first of equals. Empty if more than a third of the characters of
/// `word` differ and the candidate does not begin with `word`.
std::optional<std::string> nearest_name(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace aeroloom::cases
