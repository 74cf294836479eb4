/// Changes to a model on its way from the file to the domain. Nothing moves silently.
#pragma once

#include "geometry/vec.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

using geometry::Vec3;

/// One change of the geometry that was read.
struct Change {
  std::string what;                ///< one sentence: entity and deed
  std::optional<Vec3> where = {};  ///< a place to look at
  double how_much = 0;             ///< largest distance anything moved, in the model's unit; 0: nothing moved
  bool is_warning = false;         ///< the user may not want it

  static constexpr auto fields() {
    return std::tuple(&Change::what, &Change::where, &Change::how_much, &Change::is_warning);
  }
};

using Changes = std::vector<Change>;

/// One line for the log.
std::string describe(const Change& change);

}  // namespace aeroloom::cad
