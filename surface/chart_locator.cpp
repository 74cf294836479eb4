#include "surface/chart.hpp"
#include "surface/support_topology.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Weights above minus this count as inside: a point on an edge belongs to either triangle.
constexpr double inside_tolerance = 1e-9;
constexpr int longest_walk = 24;

double segment_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 ab = b - a;
  const double length2 = dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + t * ab);
}

/// Visits the cells a triangle meets: row by row, between its least and largest x there.
template <class Visit>
void for_each_cell(const std::array<Vec2, 3>& corners, Vec2 low, double cell, std::int32_t columns,
                   std::int32_t rows, Visit visit) {
  const auto index = [cell](double v, double origin, std::int32_t count) {
    return std::clamp(static_cast<std::int32_t>(std::floor((v - origin) / cell)), 0, count - 1);
  };
  const double bottom = std::min({corners[0].y, corners[1].y, corners[2].y});
  const double top = std::max({corners[0].y, corners[1].y, corners[2].y});
  for (std::int32_t row = index(bottom, low.y, rows); row <= index(top, low.y, rows); ++row) {
    // A little more than the row, so that rounding loses no cell.
    const double from = low.y + (row - 1e-6) * cell, to = low.y + (row + 1 + 1e-6) * cell;
    double left = 1e300, right = -1e300;
    for (int i = 0; i < 3; ++i) {
      const Vec2 a = corners[i], b = corners[(i + 1) % 3];
      if (std::max(a.y, b.y) < from || std::min(a.y, b.y) > to) continue;
      for (const double y : {std::clamp(from, std::min(a.y, b.y), std::max(a.y, b.y)),
                             std::clamp(to, std::min(a.y, b.y), std::max(a.y, b.y))}) {
        const double t = a.y != b.y ? (y - a.y) / (b.y - a.y) : 0.0;
        for (const double x :
             {a.y != b.y ? a.x + t * (b.x - a.x) : a.x, a.y != b.y ? a.x + t * (b.x - a.x) : b.x}) {
          left = std::min(left, x), right = std::max(right, x);
        }
      }
    }
    if (left > right) continue;
    for (std::int32_t column = index(left - 1e-6 * cell, low.x, columns);
         column <= index(right + 1e-6 * cell, low.x, columns); ++column) {
      visit(row * columns + column);
    }
  }
}

}  // namespace

ChartLocator::ChartLocator(const Chart& chart)
    : _chart(chart), _twins(match_half_edges(chart.support.triangles)) {
  const auto& triangles = chart.support.triangles;
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Vec2 p : chart.plane) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  for (const auto& [a, b, c] : triangles) {
    _areas.push_back(std::max(0.0, cross(chart.plane[b] - chart.plane[a], chart.plane[c] - chart.plane[a])));
  }
  const double width = std::max(high.x - low.x, 1e-300), height = std::max(high.y - low.y, 1e-300);
  const double cells = 2.0 * static_cast<double>(triangles.size()) + 1;
  _grid_low = low;
  _grid_cell = std::max(std::sqrt(width * height / cells), std::max(width, height) / cells);
  _grid_columns = static_cast<std::int32_t>(width / _grid_cell) + 1;
  _grid_rows = static_cast<std::int32_t>(height / _grid_cell) + 1;
  _cell_begin.assign(static_cast<std::size_t>(_grid_columns) * _grid_rows + 1, 0);
  // Count, then fill.
  for (const bool fill : {false, true}) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!(_areas[t] > 0)) continue;
      const auto& [a, b, c] = triangles[t];
      for_each_cell({chart.plane[a], chart.plane[b], chart.plane[c]}, _grid_low, _grid_cell, _grid_columns,
                    _grid_rows, [&](std::int32_t cell) {
                      if (fill) {
                        _cell_triangles[_cell_begin[cell]++] = static_cast<std::int32_t>(t);
                      } else {
                        ++_cell_begin[cell + 1];
                      }
                    });
    }
    if (!fill) {
      for (std::size_t i = 1; i < _cell_begin.size(); ++i) _cell_begin[i] += _cell_begin[i - 1];
      _cell_triangles.resize(_cell_begin.back());
    } else {
      for (std::size_t i = _cell_begin.size() - 1; i > 0; --i) _cell_begin[i] = _cell_begin[i - 1];
      _cell_begin[0] = 0;
    }
  }
}

std::array<double, 3> ChartLocator::weights(std::int32_t triangle, Vec2 point) const {
  const auto& [a, b, c] = _chart.support.triangles[triangle];
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
    const HalfEdge across = _twins[next_half_edge(static_cast<HalfEdge>(3 * t + least))];
    if (across < 0) return -1;
    t = across / 3;
  }
  return -1;
}

double ChartLocator::distance_to(std::int32_t triangle, Vec2 point) const {
  const auto& corners = _chart.support.triangles[triangle];
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
  const auto index = [this](double v, double origin, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(std::floor((v - origin) / _grid_cell), 0.0, count - 1.0));
  };
  const std::int32_t column = index(point.x, _grid_low.x, _grid_columns),
                     row = index(point.y, _grid_low.y, _grid_rows);
  std::int32_t best = -1;
  double least = 1e300;
  for (std::int32_t ring = 0; ring <= std::max(_grid_columns, _grid_rows); ++ring) {
    // Cells of this ring and beyond are at least ring - 1 cells away, also from a point outside the grid.
    if (best >= 0 && least <= (ring - 1) * _grid_cell) break;
    for (std::int32_t j = std::max(0, row - ring); j <= std::min(_grid_rows - 1, row + ring); ++j) {
      const bool whole_row = j == row - ring || j == row + ring;
      const std::int32_t step = whole_row || ring == 0 ? 1 : 2 * ring;
      for (std::int32_t i = column - ring; i <= column + ring; i += step) {
        if (i < 0 || i >= _grid_columns) continue;
        const std::int32_t cell = j * _grid_columns + i;
        for (std::int32_t k = _cell_begin[cell]; k < _cell_begin[cell + 1]; ++k) {
          const double away = distance_to(_cell_triangles[k], point);
          if (away < least) least = away, best = _cell_triangles[k];
        }
      }
    }
  }
  return best;
}

ChartPoint ChartLocator::evaluate(std::int32_t triangle, Vec2 point) const {
  const Support& support = _chart.support;
  ChartPoint at;
  at.triangle = triangle;
  at.weights = weights(triangle, point);
  // Parameters are not extrapolated: they might leave the surface's range.
  double inside = 0;
  for (const double w : at.weights) inside += std::max(0.0, w);
  for (int i = 0; i < 3; ++i) {
    at.point += at.weights[i] * support.points[support.triangles[triangle][i]];
    at.uv += (std::max(0.0, at.weights[i]) / inside) * support.corner_uv[triangle][i];
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
    sum += w * _chart.scale[_chart.support.triangles[at.triangle][i]];
    inside += w;
  }
  return sum / inside;
}

}  // namespace aeroloom::surface
