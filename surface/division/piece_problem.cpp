#include "surface/division/piece_problem.hpp"

#include "sizing/field/facet_integral.hpp"
#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::surface {
namespace {

/// In a facet, by its area over the size at its middle squared.
constexpr double many_elements = 2;

}  // namespace

double integrate_triangles(const ChartSurface& surface, const sizing::SizeField& field) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
    sum += sizing::integrate_facet(field, {surface.points[a], surface.points[b], surface.points[c]});
  return 4 / std::numbers::sqrt3 * sum;
}

double predict_triangles(const ChartSurface& surface, const sizing::SizeField& field) {
  double vertices = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const double area = norm(area_vector(surface, static_cast<std::int32_t>(t)));
    double density = 1 / std::pow(field((surface.points[a] + surface.points[b] + surface.points[c]) / 3), 2);
    // Sizes vary inside a facet that spans many elements: the middles of its edges stand for it.
    if (area * density > many_elements) {
      density = 0;
      for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
        density += 1 / std::pow(field(0.5 * (surface.points[p] + surface.points[q])), 2) / 3;
    }
    vertices += 2 / std::numbers::sqrt3 * area * density;
  }
  const auto twins = geometry::match_half_edges(surface.triangles);
  const auto edges =
      (static_cast<double>(twins.size()) + static_cast<double>(std::count(twins.begin(), twins.end(), -1))) /
      2;
  const double euler =
      static_cast<double>(surface.points.size()) - edges + static_cast<double>(surface.triangles.size());
  const auto border = static_cast<double>(surface.loop_edges.size());
  const double inside = std::max(0.0, vertices - border / 2 + euler);
  return std::max(1.0, 2 * inside + border - 2 * euler);
}

}  // namespace aeroloom::surface
