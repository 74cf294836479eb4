/// The style sheet of pages.
#pragma once

#include <string_view>

namespace aeroloom::page {

/// CSS for light and dark screens of any width, and for print. Loads nothing.
std::string_view style_sheet();

}  // namespace aeroloom::page
