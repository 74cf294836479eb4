/// scaling.html: a study to look at, complete in itself; a function of scaling.json alone.
#pragma once

#include <string>

namespace aeroloom::study {

std::string study_page(const std::string& json);

/// Two studies side by side, of their scaling.json: rows of the same series and ranks. For a terminal, or as
/// a page.
std::string compare_text(const std::string& old_json, const std::string& new_json);

}  // namespace aeroloom::study
