/// Writes scaling.html, a self-contained page made from scaling.json.
#pragma once

#include <string>

namespace aeroloom::study {

std::string study_page(const std::string& json);

/// Compares the scaling.json of two studies row by row (equal series and ranks), as text or as a page.
std::string compare_text(const std::string& old_json, const std::string& new_json);

}  // namespace aeroloom::study
