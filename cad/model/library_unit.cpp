#include "cad/model/library_unit.hpp"

#include "cad/tolerances.hpp"
#include "geometry/place_text.hpp"

#include <cmath>

namespace aeroloom::cad {
namespace {

thread_local double unit_at_hand = 1;

}  // namespace

double library_unit(double extent) {
  if (!std::isfinite(extent) || extent <= 0) return 1;
  if (extent >= tolerances::least_extent && extent <= tolerances::most_extent) return 1;
  return std::ldexp(1.0, std::ilogb(extent));
}

InLibraryUnit::InLibraryUnit(double unit) : _before(unit_at_hand) {
  unit_at_hand = unit;
}
InLibraryUnit::~InLibraryUnit() {
  unit_at_hand = _before;
}

double in_file(double length, int power) {
  for (int i = 0; i < power; ++i) length *= unit_at_hand;
  return length;
}

std::string place_in_file(geometry::Vec3 place) {
  return geometry::place_text(unit_at_hand * place);
}

}  // namespace aeroloom::cad
