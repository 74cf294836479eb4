/// The list of changes that were made to a geometry between the file and the domain. Every change is listed.
#pragma once

#include "geometry/vec.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// After what is said of a name that was read in another encoding than UTF-8.
inline constexpr const char* encoding_hint = " (DomainOptions::encoding names another)";

using geometry::Vec3;

/// One change to the geometry that was read.
struct Change {
  std::string what;                ///< one sentence: which entity, and what was done
  std::optional<Vec3> where = {};  ///< a place to look at
  double how_much = 0;  ///< largest distance by which anything moved, in the model's unit; 0: nothing moved
  bool is_warning = false;  ///< the user may not want this change
};

using Changes = std::vector<Change>;

/// A change whose lengths were in a unit of this length.
Change in_file_unit(Change change, double unit);

/// One line for the log.
std::string describe(const Change& change);

}  // namespace aeroloom::cad
