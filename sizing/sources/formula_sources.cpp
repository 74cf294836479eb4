// Sources of a size that is a formula of the place.
#include "sizing/sources/cells_where.hpp"
#include "sizing/sources/size_requests.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace aeroloom::sizing {

using geometry::Box;
using geometry::Vec3;

namespace {

/// Cells along the domain and along the body, at least; chosen, not measured.
constexpr double cells_along = 32;
/// Edges of cells over the size asked for there, which are between a half and one of it: of their mean
/// volume.
constexpr double mean_edge = 0.7;

Vec3 nearest_in(const Box& box, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], box.low[axis], box.high[axis]);
  return p;
}

bool meets(const Box& box, Vec3 middle, double half) {
  for (int axis = 0; axis < 3; ++axis) {
    if (middle[axis] + half <= box.low[axis] || middle[axis] - half >= box.high[axis]) return false;
  }
  return true;
}

std::array<Vec3, 8> corner_directions() {
  std::array<Vec3, 8> directions;
  for (int i = 0; i < 8; ++i) directions[i] = {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
  return directions;
}

double largest_extent_of(const Box& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// Nobody is asked for sizes outside, where the formula may have none.
double size_of_formula(const FormulaSize& formula, const FormulaSpace& space, Vec3 p) {
  const Vec3 place = 1 / formula.unit * nearest_in(space.domain, p);
  return space.coarsening * std::max(formula.unit * formula.expression(place), formula.minimum);
}

}  // namespace

double cells_of_formula(const FormulaSize& formula, const FormulaSpace& space) {
  constexpr int places = static_cast<int>(cells_along);
  const Vec3 step = 1.0 / places * space.domain.size();
  const double volume = step.x * step.y * step.z;
  double cells = 0;
  for (int i = 0; i < places * places * places; ++i) {
    const int row = i / places, layer = row / places;
    const Vec3 p = space.domain.low +
                   Vec3{(i % places + 0.5) * step.x, (row % places + 0.5) * step.y, (layer + 0.5) * step.z};
    const double size = size_of_formula(formula, space, p);
    if (size < space.limit) cells += volume / std::pow(mean_edge * size, 3);
  }
  return cells;
}

std::vector<SizeSource> sources_of_formula(const RootCube& root, const FormulaSize& formula,
                                           const FormulaSpace& space, int rank, int ranks,
                                           std::int64_t most) {
  const double in_domain = space.coarsening * largest_extent_of(space.domain) / cells_along;
  const double at_body = space.coarsening * largest_extent_of(space.body) / cells_along;
  const auto size_at = [&](Vec3 p) { return size_of_formula(formula, space, p); };
  const auto ask = [&](Vec3 middle, double half) {
    if (!meets(space.domain, middle, half)) return CubeRequest{};
    const double at_middle = size_at(middle);
    CubeRequest asked;
    asked.least = at_middle;
    for (const Vec3 to : corner_directions())
      asked.least = std::min(asked.least, size_at(middle + 0.5 * half * to));
    asked.resolution = meets(space.body, middle, half) ? std::min(in_domain, at_body) : in_domain;
    // It will be divided, unless it is as small as cells can be.
    if (2 * half > asked.least) {
      asked.size = asked.least;
      return asked;
    }
    // A corner gets the least that cells around it ask for: were that the size in their middles, the field
    // would lie below the formula by its slope times half a diagonal.
    asked.size = at_middle;
    for (const Vec3 to : corner_directions()) asked.size = std::max(asked.size, size_at(middle + half * to));
    asked.size = std::min(asked.size, asked.least + space.slope * half);
    return asked;
  };
  return sources_where(root, ask, {rank, ranks}, space.limit, most);
}

}  // namespace aeroloom::sizing
