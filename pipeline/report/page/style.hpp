/// The style sheet of pages.
#pragma once

#include <string_view>

namespace aeroloom::page {

/// CSS for screens, light and dark, wide and narrow, and for paper. Names nothing outside the page.
std::string_view style_sheet();

}  // namespace aeroloom::page
