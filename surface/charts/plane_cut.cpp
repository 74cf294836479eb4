#include "surface/charts/plane_cut.hpp"

#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::surface {
namespace {

/// An edge is not divided closer to its ends than this fraction of it: a point inside moves onto the cut
/// instead.
constexpr double least_edge_fraction = 0.1;
/// Parts below this fraction of the area are not cut off: they would be charts of a few triangles. Chosen,
/// not measured.
constexpr double least_area = 0.02;
/// The same for parts that are cut off since they lie over others: those may be small.
constexpr double least_folded_area = 1e-7;
/// The plane bends towards a mesh vertex within this many lengths of the boundary segments there: over a few
/// triangles, so that none is cut askew. Chosen, not measured.
constexpr double bend_radius = 2.5;
constexpr double kept_fraction = 0.1;
/// Levels of points that are put on a side are no less than a part of the largest, and not zero.
constexpr double off_plane = 1e-3, not_zero = 1e-300;
/// Small parts join a neighbour one by one. With more of them than this the cut is given up.
constexpr std::size_t most_absorbed = 64;

/// A mesh vertex the cut has to pass, and how far the plane misses it.
struct Bend {
  geometry::Vec3 point;
  double miss;
  double radius;
};

std::vector<double> levels_of(const ChartSurface& surface, const CutPlane& plane) {
  std::vector<double> levels;
  levels.reserve(surface.points.size());
  for (const geometry::Vec3 p : surface.points) levels.push_back(dot(plane.normal, p) - plane.offset);
  return levels;
}

/// The signed distances that define the cut: those given, bent near the boundary so that the sign changes in
/// mesh vertices alone.
class CutLevels {
public:
  CutLevels(const ChartSurface& surface, std::vector<double> levels,
            const std::vector<geometry::HalfEdge>& twins)
      : _surface(surface), _twins(twins), _levels(std::move(levels)), _on_boundary(surface.points.size(), 0) {
    double extent = 0;
    for (const double level : _levels) extent = std::max(extent, std::abs(level));
    // Points in the plane but for rounding fall on one side: they come from a CAD file, whose planes are no
    // more exact.
    constexpr double in_plane = 1e-7;
    for (double& level : _levels) {
      if (std::abs(level) < in_plane * extent) level = in_plane * extent;
    }
    for (const auto& loop : trace_boundary(surface, twins)) {
      _loops.emplace_back();
      for (const geometry::HalfEdge h : loop) {
        _loops.back().push_back(start_of(surface, h));
        _on_boundary[start_of(surface, h)] = 1;
      }
    }
    bend_to_mesh_vertices();
    separate_boundary();
    snap_interior();
  }

  const std::vector<double>& values() const { return _levels; }

private:
  bool is_mesh_vertex(std::int32_t p) const { return _surface.mesh_vertex[p] >= 0; }

  /// Calls visit(a, points between, b) for each pair of consecutive mesh vertices of a loop.
  template <class Visit>
  void for_each_segment(const std::vector<std::int32_t>& loop, Visit visit) const {
    const auto first =
        std::find_if(loop.begin(), loop.end(), [&](std::int32_t p) { return is_mesh_vertex(p); });
    if (first == loop.end()) return;
    std::int32_t from = *first;
    std::vector<std::int32_t> between;
    const std::size_t offset = static_cast<std::size_t>(first - loop.begin());
    for (std::size_t i = 1; i <= loop.size(); ++i) {
      const std::int32_t p = loop[(offset + i) % loop.size()];
      if (!is_mesh_vertex(p)) {
        between.push_back(p);
        continue;
      }
      visit(from, between, p);
      between.clear();
      from = p;
    }
  }

  /// Of two consecutive mesh vertices on different sides, the nearer one is to lie on the cut.
  void bend_to_mesh_vertices() {
    std::vector<double> radius(_levels.size(), 0);
    _on_cut.assign(_levels.size(), 0);
    for (const auto& loop : _loops) {
      for_each_segment(loop, [&](std::int32_t a, const std::vector<std::int32_t>&, std::int32_t b) {
        const double length = distance(_surface.points[a], _surface.points[b]);
        for (const std::int32_t p : {a, b}) radius[p] = std::max(radius[p], bend_radius * length);
        if (_levels[a] * _levels[b] >= 0) return;
        const double from_a = std::abs(_levels[a]), from_b = std::abs(_levels[b]);
        _on_cut[from_a < from_b || (from_a == from_b && a < b) ? a : b] = 1;
      });
    }
    std::vector<Bend> bends;
    for (std::size_t i = 0; i < _levels.size(); ++i) {
      if (_on_cut[i]) bends.push_back({_surface.points[i], _levels[i], radius[i]});
    }
    for (std::size_t i = 0; i < _levels.size(); ++i) {
      const double raw = _levels[i];
      _levels[i] = _on_cut[i] ? 0 : bent(_surface.points[i], raw, bends);
      // A bend must not push a mesh vertex to the other side: it keeps a part of its distance, and its sign.
      if (!_on_cut[i] && is_mesh_vertex(static_cast<std::int32_t>(i)) && _levels[i] * raw <= 0)
        _levels[i] = kept_fraction * raw;
    }
  }

  static double bent(geometry::Vec3 x, double raw, const std::vector<Bend>& bends) {
    double weights = 0, miss = 0;
    for (const Bend& bend : bends) {
      const geometry::Vec3 away = x - bend.point;
      const double s = dot(away, away) / (bend.radius * bend.radius);
      if (s >= 1) continue;
      const double weight = (1 - s) * (1 - s);
      weights += weight;
      miss += weight * bend.miss;
    }
    return raw - miss / std::max(1.0, weights);
  }

  /// Puts the boundary points between two mesh vertices on the side of these.
  void separate_boundary() {
    for (const auto& loop : _loops) {
      bool any = false;
      for_each_segment(loop, [&](std::int32_t a, const std::vector<std::int32_t>& between, std::int32_t b) {
        any = true;
        set_side(between, _levels[a] + _levels[b]);
      });
      if (any) continue;
      double sum = 0;
      for (const std::int32_t p : loop) sum += _levels[p];
      set_side(loop, sum);
    }
  }

  void set_side(const std::vector<std::int32_t>& points, double side) {
    double size = 0;
    for (const std::int32_t p : points) size = std::max(size, std::abs(_levels[p]));
    if (size == 0) size = std::abs(side);
    for (const std::int32_t p : points) {
      _levels[p] =
          std::copysign(std::max(std::abs(_levels[p]), off_plane * size + not_zero), side < 0 ? -1.0 : 1.0);
    }
  }

  /// Moves interior points onto the cut that it passes closely.
  void snap_interior() {
    std::vector<char> snap(_levels.size(), 0);
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(_twins.size()); ++h) {
      const std::int32_t a = start_of(_surface, h), b = end_of(_surface, h);
      if (_levels[a] * _levels[b] >= 0 || _on_boundary[a]) continue;
      if (std::abs(_levels[a]) < least_edge_fraction * std::abs(_levels[a] - _levels[b])) snap[a] = 1;
    }
    for (std::size_t i = 0; i < _levels.size(); ++i) {
      if (snap[i]) _levels[i] = 0;
    }
  }

  const ChartSurface& _surface;
  const std::vector<geometry::HalfEdge>& _twins;
  std::vector<double> _levels;
  std::vector<char> _on_boundary, _on_cut;
  std::vector<std::vector<std::int32_t>> _loops;  // points
};

/// Divides every edge whose ends lie on different sides; the new points have level 0.
void divide_at_zero(ChartSurface& surface, const std::vector<geometry::HalfEdge>& twins,
                    std::vector<double>& levels) {
  std::vector<EdgePoint> divisions;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    const geometry::HalfEdge twin = twins[h];
    if (twin >= 0 && twin < h) continue;
    const std::int32_t a = start_of(surface, h), b = end_of(surface, h);
    if (levels[a] * levels[b] >= 0) continue;
    const double part =
        std::clamp(levels[a] / (levels[a] - levels[b]), least_edge_fraction, 1 - least_edge_fraction);
    const auto index = static_cast<std::int32_t>(surface.points.size());
    surface.points.push_back((1 - part) * surface.points[a] + part * surface.points[b]);
    surface.mesh_vertex.push_back(-1);
    levels.push_back(0);
    divisions.push_back({h, part, index, (1 - part) * start_uv(surface, h) + part * end_uv(surface, h)});
    if (twin < 0) continue;
    divisions.push_back(
        {twin, 1 - part, index, part * start_uv(surface, twin) + (1 - part) * end_uv(surface, twin)});
  }
  divide_edges(surface, std::move(divisions));
}

/// Gives parts that are too small to their neighbours. Returns the number of parts left.
std::int32_t absorb_small_parts(const ChartSurface& surface, double least_part,
                                std::vector<std::int32_t>& side) {
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(surface.triangles);
  const double least = least_part * surface_area(surface);
  for (std::size_t round = 0; round < most_absorbed; ++round) {
    std::vector<std::int32_t> component;
    const std::int32_t count = label_components(twins, side, component);
    std::vector<double> area(count, 0);
    for (std::size_t t = 0; t < side.size(); ++t)
      area[component[t]] += norm(area_vector(surface, static_cast<std::int32_t>(t)));
    const auto smallest = std::min_element(area.begin(), area.end());
    if (count < 2 || *smallest >= least) return count;
    const auto absorbed = static_cast<std::int32_t>(smallest - area.begin());
    for (std::size_t t = 0; t < side.size(); ++t) {
      if (component[t] == absorbed) side[t] = 1 - side[t];
    }
  }
  return 1;
}

std::optional<CutSurface> cut_at_zero(const ChartSurface& surface, std::vector<double> raw,
                                      double least_part) {
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(surface.triangles);
  std::vector<double> levels = CutLevels(surface, std::move(raw), twins).values();
  CutSurface cut{surface, {}};
  divide_at_zero(cut.surface, twins, levels);
  for (const auto& [a, b, c] : cut.surface.triangles)
    cut.part.push_back(std::min({levels[a], levels[b], levels[c]}) < 0 ? 0 : 1);
  if (absorb_small_parts(cut.surface, least_part, cut.part) < 2) return std::nullopt;
  return cut;
}

}  // namespace

std::optional<CutSurface> cut_by_plane(const ChartSurface& surface, const CutPlane& plane) {
  return cut_at_zero(surface, levels_of(surface, plane), least_area);
}

std::optional<CutSurface> cut_by_levels(const ChartSurface& surface, std::vector<double> levels) {
  return cut_at_zero(surface, std::move(levels), least_folded_area);
}

}  // namespace aeroloom::surface
