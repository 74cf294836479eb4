/// Writes report.html, one self-contained page. It is a function of report.json and the pictures, so the two
/// always agree, and the page of an old report can be made again.
#pragma once

#include "pipeline/report/picture.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// The page; `json` is the text of report.json. The page loads nothing, runs no script and stays below 5 MB:
/// pictures that do not fit are only named, long tables end with a reference to report.json. Throws
/// nlohmann::json::exception if `json` is no JSON.
std::string report_html(const std::string& json, const std::vector<Picture>& pictures);

}  // namespace aeroloom::report
