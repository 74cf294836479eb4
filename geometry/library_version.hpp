/// The version of the library of exact predicates, for the report.
#pragma once

#include <string>

namespace aeroloom::geometry {

/// The version of CGAL at compile time.
std::string cgal_version();

}  // namespace aeroloom::geometry
