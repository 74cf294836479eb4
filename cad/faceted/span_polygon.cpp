#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/fill_openings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace aeroloom::cad {
namespace {

/// Polygons of more corners are cut: weighing takes time with the third power. Chosen, not measured.
constexpr std::int32_t most_weighed = 160;
/// Squared sides count so much beside areas: enough to prefer short sides where areas are equal, as in a
/// plane, too little to prefer a triangle outside of a planar polygon. Chosen, not measured.
constexpr double weight_of_sides = 0.01;
constexpr double forbidden = std::numeric_limits<double>::infinity();

class PolygonSpanner {
public:
  PolygonSpanner(std::span<const Vec3> corners, const ChordRule& allowed)
      : _corners(corners), _allowed(allowed) {}

  std::vector<geometry::TriangleCorners> span() {
    std::vector<std::int32_t> all(_corners.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
    std::vector<std::vector<std::int32_t>> waiting{std::move(all)};
    while (!waiting.empty()) {
      const std::vector<std::int32_t> polygon = std::move(waiting.back());
      waiting.pop_back();
      if (static_cast<std::int32_t>(polygon.size()) <= most_weighed) {
        if (!weigh(polygon)) return {};
        continue;
      }
      const auto [i, j] = shortest_chord(polygon);
      if (j < 0) return {};
      waiting.emplace_back(polygon.begin() + i, polygon.begin() + j + 1);
      std::vector<std::int32_t>& rest = waiting.emplace_back(polygon.begin(), polygon.begin() + i + 1);
      rest.insert(rest.end(), polygon.begin() + j, polygon.end());
    }
    return std::move(_triangles);
  }

private:
  /// Between places of a polygon that leave at least a quarter of its corners on both sides.
  std::pair<std::int32_t, std::int32_t> shortest_chord(const std::vector<std::int32_t>& polygon) const {
    const auto count = static_cast<std::int32_t>(polygon.size());
    std::pair<std::int32_t, std::int32_t> best(-1, -1);
    double shortest = forbidden;
    for (std::int32_t i = 0; i < count; ++i) {
      for (std::int32_t j = i + count / 4; j < count && j - i <= count - count / 4; ++j) {
        const double length = distance(_corners[polygon[i]], _corners[polygon[j]]);
        if (length >= shortest || length == 0 || !_allowed(polygon[i], polygon[j])) continue;
        shortest = length, best = {i, j};
      }
    }
    return best;
  }

  double weight(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const Vec3 a = _corners[i], b = _corners[j], c = _corners[k];
    if (on_one_line(a, b, c)) return forbidden;
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    return 0.5 * norm(cross(ab, ca)) + weight_of_sides * (dot(ab, ab) + dot(bc, bc) + dot(ca, ca));
  }

  /// Of all ways to cut a polygon into triangles, the one with the least sum of weights.
  bool weigh(const std::vector<std::int32_t>& polygon) {
    const std::size_t count = polygon.size();
    std::vector<double> least(count * count, 0);
    std::vector<std::int32_t> apex(count * count, -1);
    for (std::size_t length = 2; length < count; ++length) {
      for (std::size_t i = 0; i + length < count; ++i) {
        const std::size_t k = i + length;
        double& best = least[i * count + k];
        best = forbidden;
        if (length + 1 < count && !_allowed(polygon[i], polygon[k])) continue;
        for (std::size_t j = i + 1; j < k; ++j) {
          const double before = least[i * count + j] + least[j * count + k];
          if (!(before < best)) continue;
          const double sum = before + weight(polygon[i], polygon[j], polygon[k]);
          if (sum < best) best = sum, apex[i * count + k] = static_cast<std::int32_t>(j);
        }
      }
    }
    if (!(least[count - 1] < forbidden)) return false;
    std::vector<std::pair<std::size_t, std::size_t>> waiting{{0, count - 1}};
    while (!waiting.empty()) {
      const auto [i, k] = waiting.back();
      waiting.pop_back();
      if (k - i < 2) continue;
      const auto j = static_cast<std::size_t>(apex[i * count + k]);
      _triangles.push_back({polygon[i], polygon[j], polygon[k]});
      waiting.emplace_back(i, j), waiting.emplace_back(j, k);
    }
    return true;
  }

  std::span<const Vec3> _corners;
  const ChordRule& _allowed;
  std::vector<geometry::TriangleCorners> _triangles;
};

}  // namespace

std::vector<geometry::TriangleCorners> span_polygon(std::span<const Vec3> corners, const ChordRule& allowed) {
  return corners.size() < 3 ? std::vector<geometry::TriangleCorners>{}
                            : PolygonSpanner(corners, allowed).span();
}

}  // namespace aeroloom::cad
