/// The style sheet of report.html.
#pragma once

#include <string_view>

namespace aeroloom::pipeline::html {

/// CSS for screens, light and dark, wide and narrow, and for paper. Names nothing outside the page.
std::string_view style_sheet();

}  // namespace aeroloom::pipeline::html
