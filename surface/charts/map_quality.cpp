#include "geometry/angle.hpp"
#include "geometry/plane_grid.hpp"
#include "geometry/predicates.hpp"
#include "geometry/runs.hpp"
#include "surface/charts/conformal_map.hpp"
#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

struct Weighted {
  double value, weight;
};

// Shares of the area that ratios are judged by: slivers of facets may have any. The two of scales leave out
// as much together as the one of stretch.
constexpr double nearly_all = 0.99, lowest = 0.005, highest = 0.995;

/// The value below which the given fraction of the weight lies.
double quantile(std::vector<Weighted>& items, double fraction) {
  if (items.empty()) return 0;
  std::sort(items.begin(), items.end(), [](const Weighted& a, const Weighted& b) {
    return a.value != b.value ? a.value < b.value : a.weight < b.weight;
  });
  double total = 0, sum = 0;
  for (const Weighted& item : items) total += item.weight;
  for (const Weighted& item : items) {
    sum += item.weight;
    if (sum >= fraction * total) return item.value;
  }
  return items.back().value;
}

/// Singular values of the map of one triangle; the smaller is negative where it turns over.
struct SingularValues {
  double large, small;
};

SingularValues triangle_stretch(Vec3 ab, Vec3 ac, Vec2 plane_ab, Vec2 plane_ac) {
  const double length = norm(ab);
  const double x = dot(ab, ac) / length, y = norm(cross(ab, ac)) / length;
  // Columns of the Jacobian in the triangle's frame.
  const Vec2 ju = plane_ab / length, jv = (plane_ac - x * ju) / y;
  const double conformal = std::hypot(ju.x + jv.y, ju.y - jv.x), anti = std::hypot(ju.x - jv.y, ju.y + jv.x);
  return {0.5 * (conformal + anti), 0.5 * (conformal - anti)};
}

/// Segments of the boundary hashed into a uniform grid, so that crossings are looked for among neighbours
/// alone.
class BoundaryCrossings {
public:
  BoundaryCrossings(const PlaneMap& map, const std::vector<std::array<std::int32_t, 2>>& edges)
      : _map(map), _edges(edges) {}

  bool any() {
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    double length = 0;
    for (const auto& [a, b] : _edges) {
      length += distance(_map[a], _map[b]);
      for (const std::int32_t p : {a, b}) {
        low = {std::min(low.x, _map[p].x), std::min(low.y, _map[p].y)};
        high = {std::max(high.x, _map[p].x), std::max(high.y, _map[p].y)};
      }
    }
    const double count = static_cast<double>(_edges.size());
    constexpr double most_cells = 1000;  // along the extent, however short edges are
    const double extent = std::max(high.x - low.x, high.y - low.y);
    if (!(extent > 0) || !std::isfinite(extent)) return true;
    const double cell = std::max(2 * length / count, extent / most_cells);
    struct GridEdge {
      std::int32_t column, row, edge;
      auto operator<=>(const GridEdge&) const = default;
    };
    std::vector<GridEdge> entries;
    for (std::size_t e = 0; e < _edges.size(); ++e) {
      const Vec2 a = _map[_edges[e][0]], b = _map[_edges[e][1]];
      const auto from = [&](double v, double o) { return static_cast<std::int32_t>((v - o) / cell); };
      for (std::int32_t i = from(std::min(a.x, b.x), low.x); i <= from(std::max(a.x, b.x), low.x); ++i) {
        for (std::int32_t j = from(std::min(a.y, b.y), low.y); j <= from(std::max(a.y, b.y), low.y); ++j)
          entries.push_back({i, j, static_cast<std::int32_t>(e)});
      }
    }
    std::sort(entries.begin(), entries.end());
    bool crossing = false;
    const auto same_cell = [](const auto& a, const auto& b) {
      return a.column == b.column && a.row == b.row;
    };
    geometry::for_each_run(
        std::span<const GridEdge>(entries), same_cell, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end && !crossing; ++i) {
            for (std::size_t j = i + 1; j < end && !crossing; ++j)
              crossing = cross_each_other(_edges[entries[i].edge], _edges[entries[j].edge]);
          }
        });
    return crossing;
  }

private:
  bool cross_each_other(const std::array<std::int32_t, 2>& e, const std::array<std::int32_t, 2>& f) const {
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
    const Vec2 a = _map[e[0]], b = _map[e[1]], c = _map[f[0]], d = _map[f[1]];
    if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
        std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) {
      return false;
    }
    return geometry::orient2d(a, b, c) * geometry::orient2d(a, b, d) < 0 &&
           geometry::orient2d(c, d, a) * geometry::orient2d(c, d, b) < 0;
  }

  const PlaneMap& _map;
  const std::vector<std::array<std::int32_t, 2>>& _edges;
};

/// Whether the boundary's image may bound more than one sheet: loops cross, or not exactly one runs
/// counter-clockwise. With simple loops the number of sheets over a point is its winding number.
bool may_overlap(const ChartSurface& surface, const PlaneMap& map) {
  std::vector<std::array<std::int32_t, 2>> edges;
  int outer = 0;
  for (const auto& loop : trace_boundary(surface, geometry::match_half_edges(surface.triangles))) {
    double area = 0;
    for (const geometry::HalfEdge h : loop) {
      edges.push_back({start_of(surface, h), end_of(surface, h)});
      area += cross(map[edges.back()[0]] - map[0], map[edges.back()[1]] - map[0]);
    }
    outer += area > 0;
  }
  return outer != 1 || BoundaryCrossings(map, edges).any();
}

/// The fraction of triangles (by area in space) whose centre lies in another triangle as well. Near sharp
/// corners chords of curves may cross where the curves do not: that is little.
double overlap_fraction(const ChartSurface& surface, const PlaneMap& map) {
  const geometry::PlaneGrid grid(map, surface.triangles);
  const auto is_inside = [&](Vec2 p, std::int32_t triangle) {
    const auto& [a, b, c] = surface.triangles[triangle];
    // Cells of the grid hold many triangles where the chart surface is fine: boxes sort most of them out.
    if (p.x < std::min({map[a].x, map[b].x, map[c].x}) || p.x > std::max({map[a].x, map[b].x, map[c].x}) ||
        p.y < std::min({map[a].y, map[b].y, map[c].y}) || p.y > std::max({map[a].y, map[b].y, map[c].y})) {
      return false;
    }
    return geometry::orient2d(map[a], map[b], p) > 0 && geometry::orient2d(map[b], map[c], p) > 0 &&
           geometry::orient2d(map[c], map[a], p) > 0;
  };
  double total = 0, covered = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const double area = norm(area_vector(surface, static_cast<std::int32_t>(t)));
    const Vec2 center = (map[a] + map[b] + map[c]) / 3;
    const auto [column, row] = grid.cell_of(center);
    const auto near = grid.triangles_in(column, row);
    total += area;
    const bool twice = std::any_of(near.begin(), near.end(), [&](std::int32_t other) {
      return other != static_cast<std::int32_t>(t) && is_inside(center, other);
    });
    if (twice) covered += area;
  }
  return total > 0 ? covered / total : 1;
}

}  // namespace

MapQuality judge_map(const ChartSurface& surface, const PlaneMap& map) {
  std::vector<Weighted> stretches, scales;
  double total = 0, folded = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const double area = norm(area_vector(surface, static_cast<std::int32_t>(t)));
    total += area;
    if (geometry::orient2d(map[a], map[b], map[c]) <= 0) {
      folded += std::max(area, 0.5 * std::abs(cross(map[b] - map[a], map[c] - map[a])));
      continue;
    }
    if (!(area > 0)) continue;
    const SingularValues stretch =
        triangle_stretch(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a],
                         map[b] - map[a], map[c] - map[a]);
    stretches.push_back({stretch.small > 0 ? stretch.large / stretch.small : 1e300, area});
    scales.push_back({std::sqrt(std::max(0.0, stretch.large * stretch.small)), area});
  }
  MapQuality quality;
  quality.folded = total > 0 ? folded / total : 1;
  quality.stretch = quantile(stretches, nearly_all);
  const double smallest = quantile(scales, lowest), largest = quantile(scales, highest);
  quality.scale_ratio = smallest > 0 ? largest / smallest : 1e300;
  quality.overlap = may_overlap(surface, map) ? overlap_fraction(surface, map) : 0;
  quality.loops_cross = !surface.loop_edges.empty() && BoundaryCrossings(map, surface.loop_edges).any();
  return quality;
}

double normal_spread(const ChartSurface& surface) {
  Vec3 mean;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    mean += area_vector(surface, static_cast<std::int32_t>(t));
  std::vector<Weighted> angles;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vec3 normal = area_vector(surface, static_cast<std::int32_t>(t));
    angles.push_back({angle_between(mean, normal), norm(normal)});
  }
  return quantile(angles, nearly_all);
}

}  // namespace aeroloom::surface
