#include "surface/charts/chart.hpp"
#include "surface/charts/surface_topology.hpp"

#include <algorithm>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;

/// Weights above minus this count as inside: a point on an edge belongs to either triangle.
constexpr double inside_tolerance = 1e-9;
/// Triangles; beyond, the grid finds the point sooner. Chosen, not measured.
constexpr int longest_walk = 24;

double segment_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 ab = b - a;
  const double length2 = dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + t * ab);
}

}  // namespace

ChartLocator::ChartLocator(const Chart& chart)
    : _chart(chart),
      _twins(geometry::match_half_edges(chart.surface.triangles)),
      _grid(chart.plane, chart.surface.triangles) {
  for (const auto& [a, b, c] : chart.surface.triangles)
    _areas.push_back(cross(chart.plane[b] - chart.plane[a], chart.plane[c] - chart.plane[a]));
}

std::array<double, 3> ChartLocator::weights(std::int32_t triangle, Vec2 point) const {
  const auto& [a, b, c] = _chart.surface.triangles[triangle];
  const Vec2 pa = _chart.plane[a] - point, pb = _chart.plane[b] - point, pc = _chart.plane[c] - point;
  const double area = _areas[triangle];
  const double first = cross(pb, pc) / area, second = cross(pc, pa) / area;
  return {first, second, 1 - first - second};
}

std::int32_t ChartLocator::walk(Vec2 point, std::int32_t from) const {
  std::int32_t t = from;
  for (int step = 0; step < longest_walk && _areas[t] > 0; ++step) {
    const auto w = weights(t, point);
    const auto least = std::min_element(w.begin(), w.end()) - w.begin();
    if (w[least] >= -inside_tolerance) return t;
    const geometry::HalfEdge across =
        _twins[geometry::next_half_edge(static_cast<geometry::HalfEdge>(3 * t + least))];
    if (across < 0) return -1;
    t = across / 3;
  }
  return -1;
}

double ChartLocator::distance_to_box(std::int32_t triangle, Vec2 point) const {
  const auto& [a, b, c] = _chart.surface.triangles[triangle];
  const Vec2 p = _chart.plane[a], q = _chart.plane[b], r = _chart.plane[c];
  const double x = std::max({std::min({p.x, q.x, r.x}) - point.x, point.x - std::max({p.x, q.x, r.x}), 0.0});
  const double y = std::max({std::min({p.y, q.y, r.y}) - point.y, point.y - std::max({p.y, q.y, r.y}), 0.0});
  return std::max(x, y);
}

double ChartLocator::distance_to(std::int32_t triangle, Vec2 point) const {
  const auto& corners = _chart.surface.triangles[triangle];
  const auto w = weights(triangle, point);
  if (std::min({w[0], w[1], w[2]}) >= -inside_tolerance) return 0;
  double least = 1e300;
  for (int i = 0; i < 3; ++i) {
    least = std::min(least,
                     segment_distance(point, _chart.plane[corners[i]], _chart.plane[corners[(i + 1) % 3]]));
  }
  return least;
}

std::int32_t ChartLocator::nearest(Vec2 point) const {
  const auto [column, row] = _grid.cell_of(point);
  std::int32_t best = -1;
  double least = 1e300;
  for (std::int32_t ring = 0; ring <= std::max(_grid.columns(), _grid.rows()); ++ring) {
    // Cells of this ring and beyond are at least ring - 1 cells away, also from a point outside the grid.
    if (best >= 0 && least <= (ring - 1) * _grid.cell_size()) break;
    for (std::int32_t j = std::max(0, row - ring); j <= std::min(_grid.rows() - 1, row + ring); ++j) {
      const bool whole_row = j == row - ring || j == row + ring;
      for (std::int32_t i = column - ring; i <= column + ring; i += whole_row ? 1 : 2 * ring) {
        if (i < 0 || i >= _grid.columns()) continue;
        for (const std::int32_t t : _grid.triangles_in(i, j)) {
          if (distance_to_box(t, point) > least) continue;
          const double away = distance_to(t, point);
          if (away < least) least = away, best = t;
          if (least == 0) return best;
        }
      }
    }
  }
  return best;
}

ChartPoint ChartLocator::evaluate(std::int32_t triangle, Vec2 point) const {
  const ChartSurface& surface = _chart.surface;
  ChartPoint at;
  at.triangle = triangle;
  at.weights = weights(triangle, point);
  // Parameters are not extrapolated: they might leave the surface's range.
  double inside = 0;
  for (const double w : at.weights) inside += std::max(0.0, w);
  for (int i = 0; i < 3; ++i) {
    at.point += at.weights[i] * surface.points[surface.triangles[triangle][i]];
    at.uv += (std::max(0.0, at.weights[i]) / inside) * surface.corner_uv[triangle][i];
  }
  return at;
}

ChartPoint ChartLocator::locate(Vec2 point, std::int32_t& hint) const {
  const auto count = static_cast<std::int32_t>(_areas.size());
  std::int32_t found = hint >= 0 && hint < count ? walk(point, hint) : -1;
  if (found < 0) found = nearest(point);
  hint = std::max(found, 0);
  return evaluate(hint, point);
}

double ChartLocator::scale(const ChartPoint& at) const {
  double sum = 0, inside = 0;
  for (int i = 0; i < 3; ++i) {
    const double w = std::max(0.0, at.weights[i]);
    sum += w * _chart.scale[_chart.surface.triangles[at.triangle][i]];
    inside += w;
  }
  return sum / inside;
}

}  // namespace aeroloom::surface
