/// report.html: one page that needs nothing but itself. It is a function of report.json and the pictures, so
/// that the two can never say different things, and that the page of any report can be made again.
#pragma once

#include "pipeline/report/picture.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// The page; `json` is the text of report.json. It makes no request, runs no script and is below 5 MB:
/// pictures that do not fit are named, and long tables end where they say that more is in report.json.
/// Throws nlohmann::json::exception for what is no JSON.
std::string report_html(const std::string& json, const std::vector<Picture>& pictures);

}  // namespace aeroloom::report
