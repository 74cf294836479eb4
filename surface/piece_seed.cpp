#include "surface/piece_seed.hpp"

#include "surface/support_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

constexpr double part_per_size = 3;  // edge of a part of a facet that one size stands for
constexpr int most_bisections = 30;

double integrate(const sizing::SizeField& field, const std::array<Vec3, 3>& t, int depth) {
  int longest = 0;
  double length = 0;
  for (int i = 0; i < 3; ++i) {
    const double edge = distance(t[i], t[(i + 1) % 3]);
    if (edge > length) length = edge, longest = i;
  }
  const double h = field((t[0] + t[1] + t[2]) / 3.0);
  if (length <= part_per_size * h || depth == most_bisections)
    return 2 / std::numbers::sqrt3 * norm(cross(t[1] - t[0], t[2] - t[0])) / (h * h);
  const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3], middle = 0.5 * (a + b);
  return integrate(field, {a, middle, c}, depth + 1) + integrate(field, {middle, b, c}, depth + 1);
}

}  // namespace

double integrate_triangles(const Support& support, const sizing::SizeField& field) {
  double triangles = 0;
  for (const auto& [a, b, c] : support.triangles)
    triangles += integrate(field, {support.points[a], support.points[b], support.points[c]}, 0);
  return triangles;
}

double predict_triangles(const Support& support, const sizing::SizeField& field) {
  double vertices = 0;
  for (std::size_t t = 0; t < support.triangles.size(); ++t) {
    const auto& [a, b, c] = support.triangles[t];
    const double area = norm(area_vector(support, static_cast<std::int32_t>(t)));
    // Sizes vary inside a facet that spans many elements: the middles of its edges stand for it.
    double density = 0;
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
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
