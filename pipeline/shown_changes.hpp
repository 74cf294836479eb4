/// Long lists of changes for people: those that moved most, and how many more there are.
#pragma once

#include "cad/repair/change.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// A line for each change, or for the three that moved most; the last line then says how many more there are
/// and that `all_of_them` lists them.
std::vector<std::string> shown_changes(cad::Changes changes, const std::string& all_of_them);

}  // namespace aeroloom::pipeline
