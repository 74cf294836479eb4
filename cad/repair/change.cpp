#include "cad/repair/change.hpp"

#include "geometry/place_text.hpp"

#include <fmt/format.h>

namespace aeroloom::cad {

Change in_file_unit(Change change, double unit) {
  if (change.where) change.where = unit * *change.where;
  change.how_much *= unit;
  return change;
}

std::string describe(const Change& change) {
  std::string text = change.what;
  if (change.where) {
    text += fmt::format(" at {}", geometry::place_text(*change.where));
  }
  if (change.how_much > 0) text += fmt::format(", moved by at most {:.3g}", change.how_much);
  return text;
}

}  // namespace aeroloom::cad
