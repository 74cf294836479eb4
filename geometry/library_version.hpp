/// The library of exact predicates, for those who may not see it.
#pragma once

#include <string>

namespace aeroloom::geometry {

/// Of CGAL, as it was compiled against.
std::string cgal_version();

}  // namespace aeroloom::geometry
