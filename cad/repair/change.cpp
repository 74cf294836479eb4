#include "cad/repair/change.hpp"

#include <fmt/format.h>

namespace aeroloom::cad {

std::string describe(const Change& change) {
  std::string text = change.what;
  if (change.where) {
    text += fmt::format(" at ({:.6g}, {:.6g}, {:.6g})", change.where->x, change.where->y, change.where->z);
  }
  if (change.how_much > 0) text += fmt::format(", moved by at most {:.3g}", change.how_much);
  return text;
}

}  // namespace aeroloom::cad
