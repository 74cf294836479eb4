/// Writes scaling.html, a self-contained page made from scaling.json.
#pragma once

#include <string>

namespace aeroloom::study {

std::string study_page(const std::string& json);

}  // namespace aeroloom::study
