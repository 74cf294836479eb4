#include "sizing/field/facet_integral.hpp"

#include "sizing/field/curvature_size.hpp"

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;
using Triangle = std::array<Vec3, 3>;

// Chosen, not measured: edges, over h, of a part of a facet that one value of h stands for; area, over its
// square, of a facet that is not cut.
constexpr double facet_per_size = 3, needle_per_element = 1e-3;

/// Whether there is room for next to nothing of an element, by the sizes in the middle and at the corners.
/// Facets of a face whose edges are cut finely may be needles along these by the ten thousand.
bool is_needle(const SizeField& field, const Triangle& t, double area, double size_in_middle) {
  const auto has_room = [&](double h) { return area > needle_per_element * h * h; };
  return !has_room(size_in_middle) && !has_room(field(t[0])) && !has_room(field(t[1])) &&
         !has_room(field(t[2]));
}

/// Integral of 1/h^2 over one facet.
double integrate(const SizeField& field, const Triangle& t, int depth) {
  int longest = 0;
  double length = 0;
  for (int i = 0; i < 3; ++i) {
    const double edge = distance(t[i], t[(i + 1) % 3]);
    if (edge > length) length = edge, longest = i;
  }
  const double h = field((t[0] + t[1] + t[2]) / 3.0), area = 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
  if (length <= facet_per_size * h || depth >= deepest_bisection || is_needle(field, t, area, h))
    return area / (h * h);
  const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3], middle = 0.5 * (a + b);
  return integrate(field, {a, middle, c}, depth + 1) + integrate(field, {middle, b, c}, depth + 1);
}

}  // namespace

double integrate_facet(const SizeField& field, const std::array<Vec3, 3>& facet) {
  return integrate(field, facet, 0);
}

}  // namespace aeroloom::sizing
