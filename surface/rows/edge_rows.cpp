#include "surface/rows/edge_rows.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

/// Segments that are not longer than this times the first height are left to isotropic triangles. Chosen, not
/// measured.
constexpr double least_stretch = 1.5;

}  // namespace

double row_height(const EdgeRows& rows, int row) {
  return rows.height * std::pow(rows.growth, row);
}

double breadth_of(const EdgeRows& rows, int count) {
  double breadth = 0;
  for (int row = 0; row < count; ++row) breadth += row_height(rows, row);
  return breadth;
}

std::vector<int> count_rows(std::span<const geometry::Vec3> vertices, const EdgeRows& rows) {
  std::vector<int> counts(vertices.size(), 0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    // The shorter of the two: a row higher than a segment is long would be stretched across the edge.
    const double length =
        std::min(distance(vertices[i - 1], vertices[i]), distance(vertices[i], vertices[i + 1]));
    while (length > least_stretch * rows.height && row_height(rows, counts[i]) <= length) ++counts[i];
  }
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] = std::min(counts[i], counts[i - 1] + 1);
  for (std::size_t i = counts.size(); i-- > 1;) counts[i - 1] = std::min(counts[i - 1], counts[i] + 1);
  return counts;
}

}  // namespace aeroloom::surface
