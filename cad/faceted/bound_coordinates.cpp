#include "cad/faceted/facet_soup.hpp"
#include "cad/model/model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::cad {

void bound_coordinates(FacetSoup& soup) {
  // Five differences are multiplied at most, with an error of 1e-16 each, which has to be a number too.
  constexpr double relative = 0x1p-120, least = 1e-45, largest_allowed = 1e30, smallest_allowed = 1e-30;
  double largest = 0;
  for (const geometry::Vec3& p : soup.points)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (largest > largest_allowed || (largest > 0 && largest < smallest_allowed)) {
    throw CadError(
        fmt::format("{}: the largest coordinate is {:.3g}, but only such from {:.0g} to {:.0g} can be "
                    "calculated with. Remedy: write the file in another unit, or leave out the points that "
                    "do not belong to the body",
                    soup.file, largest, smallest_allowed, largest_allowed));
  }
  const double smallest = std::max(relative * largest, least);
  for (geometry::Vec3& p : soup.points) {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] == 0 || std::abs(p[axis]) >= smallest) continue;
      p[axis] = 0;
      ++soup.zeroed;
    }
  }
}

}  // namespace aeroloom::cad
