/// Shortens long lists of CAD changes for messages.
#pragma once

#include "cad/repair/change.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// One line for each change. Of long lists: the three with the largest displacement, and a line with the
/// number of others and `all_of_them`, the place of the full list.
std::vector<std::string> shown_changes(cad::Changes changes, const std::string& all_of_them);

}  // namespace aeroloom::pipeline
