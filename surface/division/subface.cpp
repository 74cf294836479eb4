#include "surface/division/subface.hpp"

#include "sizing/field/facet_integral.hpp"
#include "surface/charts/support_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::surface {
namespace {

/// In a facet, by its area over the size at its middle squared.
constexpr double many_elements = 2;

}  // namespace

double integrate_triangles(const Support& support, const sizing::SizeField& field) {
  double sum = 0;
  for (const auto& [a, b, c] : support.triangles)
    sum += sizing::integrate_facet(field, {support.points[a], support.points[b], support.points[c]});
  return 4 / std::numbers::sqrt3 * sum;
}

double predict_triangles(const Support& support, const sizing::SizeField& field) {
  double vertices = 0;
  for (std::size_t t = 0; t < support.triangles.size(); ++t) {
    const auto& [a, b, c] = support.triangles[t];
    const double area = norm(area_vector(support, static_cast<std::int32_t>(t)));
    double density = 1 / std::pow(field((support.points[a] + support.points[b] + support.points[c]) / 3), 2);
    // Sizes vary inside a facet that spans many elements: the middles of its edges stand for it.
    if (area * density > many_elements) {
      density = 0;
      for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
        density += 1 / std::pow(field(0.5 * (support.points[p] + support.points[q])), 2) / 3;
    }
    vertices += 2 / std::numbers::sqrt3 * area * density;
  }
  const auto twins = geometry::match_half_edges(support.triangles);
  const auto edges =
      (static_cast<double>(twins.size()) + static_cast<double>(std::count(twins.begin(), twins.end(), -1))) /
      2;
  const double euler =
      static_cast<double>(support.points.size()) - edges + static_cast<double>(support.triangles.size());
  const auto border = static_cast<double>(support.loop_edges.size());
  const double inside = std::max(0.0, vertices - border / 2 + euler);
  return std::max(1.0, 2 * inside + border - 2 * euler);
}

}  // namespace aeroloom::surface
