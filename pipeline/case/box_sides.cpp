#include "pipeline/case/box_sides.hpp"

#include "cad/model/patches.hpp"

#include <algorithm>
#include <array>

namespace aeroloom::cases {

namespace {

constexpr std::array box_sides{"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

}  // namespace

std::string hint_on_box_sides(const cad::Model& model, const std::string& pattern) {
  const cad::NamePattern sides(pattern);
  const bool names_a_side =
      std::ranges::any_of(box_sides, [&](const char* side) { return sides.matches(side); });
  if (!names_a_side || !cad::is_around_bodies(model)) return {};
  return "; the solids of the file were taken as a body in a far field, and only a fluid has the patches "
         "'xmin' to 'zmax'. `geometry.domain: fluid` takes the solids as the space to mesh";
}

}  // namespace aeroloom::cases
