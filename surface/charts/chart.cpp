#include "surface/charts/chart.hpp"

#include "geometry/angle.hpp"
#include "geometry/place_text.hpp"
#include "surface/charts/conformal_map.hpp"
#include "surface/charts/cut_curves.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/plane_cut.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/surface_error.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::degree;
/// Below this spread of normals a parallel projection stretches by less than 7 %.
constexpr double projection_spread = 20 * degree;
/// Slivers may fold as long as they carry no more than this fraction of the area: a chart that obeys its
/// limits, and one that is the best to be had.
constexpr double acceptable_fold = 1e-4, bearable_fold = 1e-3;
/// The limit for parts that lie over others: chords of curves that meet at a sharp angle cross near their
/// meeting point.
constexpr double acceptable_overlap = 1e-3, bearable_overlap = 2e-2;
/// A flat domain may exceed the limits of stretch and scale so often before it is split.
constexpr double endurable_excess = 2;
/// A domain below this area, in squares of the size, is not split any further. Any map does for them.
constexpr double few_elements = 4;
/// Chart surfaces with more points are split before they are mapped: factors of the map's equations grow
/// faster than points, and triangles of a file may be any number. Chosen, not measured.
constexpr std::size_t most_points = 40000;
/// Of the map that keeps triangles as rigid as may be; each lowers its energy. Chosen, not measured.
constexpr int rigid_steps = 15;
/// 16,384 charts of a face: a face that asks for more has no sensible normals (docs/bounds.md).
constexpr int deepest_split = 14;

struct Candidate {
  PlaneMap map;
  MapQuality quality;
};

bool is_acceptable(const MapQuality& quality, const ChartLimits& limits) {
  return !quality.loops_cross && quality.overlap <= acceptable_overlap && quality.folded <= acceptable_fold &&
         quality.stretch <= limits.stretch && quality.scale_ratio <= limits.scale_ratio;
}

bool is_bearable(const MapQuality& quality) {
  return quality.overlap <= bearable_overlap && quality.folded <= bearable_fold;
}

/// How often a map exceeds its limits.
double excess(const MapQuality& quality, const ChartLimits& limits) {
  return std::max(quality.stretch / limits.stretch, quality.scale_ratio / limits.scale_ratio);
}

bool is_better(const MapQuality& a, const MapQuality& b, const ChartLimits& limits) {
  if (is_bearable(a) != is_bearable(b)) return is_bearable(a);
  if (a.loops_cross != b.loops_cross) return b.loops_cross;
  return excess(a, limits) < excess(b, limits);
}

/// Tries maps from the cheapest to the most patient; the first acceptable one, or the best of all.
Candidate choose_map(const ChartSurface& surface, const ChartLimits& limits, double spread) {
  const PlaneMap projection = project_to_mean_plane(surface);
  Candidate best{projection, judge_map(surface, projection)};
  const auto consider = [&](std::optional<PlaneMap> map) {
    if (!map) return;
    Candidate candidate{std::move(*map), {}};
    candidate.quality = judge_map(surface, candidate.map);
    const bool better =
        is_acceptable(candidate.quality, limits) || is_better(candidate.quality, best.quality, limits);
    if (better) best = std::move(candidate);
  };
  if (spread <= projection_spread && is_acceptable(best.quality, limits)) return best;
  const std::optional<PlaneMap> conformal = map_conformally(surface, projection);
  consider(conformal);
  if (!is_acceptable(best.quality, limits) && conformal)
    consider(map_rigidly(surface, *conformal, rigid_steps));
  if (!is_acceptable(best.quality, limits)) consider(scale_parameters(surface));
  return best;
}

struct ChartDomain {
  ChartSurface surface;
  int depth;
  std::optional<Candidate> best = {};  ///< of the maps tried
};

class ChartMaker {
public:
  ChartMaker(const cad::Model& model, const sizing::SizeField& field, const ChartLimits& limits,
             FaceVertices& vertices)
      : _model(model), _field(field), _limits(limits), _vertices(vertices) {}

  std::vector<Chart> run(const ChartSurface& whole) {
    _joined = joined_vertices(whole);
    const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(whole.triangles);
    std::vector<std::int32_t> component;
    const std::vector<std::int32_t> alike(whole.triangles.size(), 0);
    const std::int32_t count = label_components(twins, alike, component);
    return run(separate_parts(whole, twins, component, count), 0);
  }

  /// Parts of a surface that was cut `depth` times.
  std::vector<Chart> run(std::vector<ChartSurface> parts, int depth, JoinedVertices joined) {
    _joined = std::move(joined);
    return run(std::move(parts), depth);
  }

private:
  std::vector<Chart> run(std::vector<ChartSurface> parts, int depth) {
    push(std::move(parts), depth);
    while (!_waiting.empty()) {
      ChartDomain domain = std::move(_waiting.back());
      _waiting.pop_back();
      if (!map_whole(domain)) split(std::move(domain));
    }
    return std::move(_charts);
  }

  void push(std::vector<ChartSurface> parts, int depth) {
    for (std::size_t i = parts.size(); i-- > 0;) _waiting.push_back({std::move(parts[i]), depth, {}});
  }

  void accept(ChartSurface surface, PlaneMap map) {
    Chart chart{std::move(surface), std::move(map), {}};
    chart.scale = point_scales(chart.surface, chart.plane);
    _charts.push_back(std::move(chart));
  }

  /// Maps the domain to one chart if it fits the limits, or is not worth being split any further.
  bool map_whole(ChartDomain& domain) {
    const ChartSurface& surface = domain.surface;
    if (_model.is_planar(surface.face)) {
      PlaneMap map = project_to_mean_plane(surface);
      accept(std::move(domain.surface), std::move(map));
      return true;
    }
    if (!is_planar_domain(surface)) return false;
    if (surface.points.size() > most_points && domain.depth < deepest_split) return false;
    const double spread = normal_spread(surface);
    domain.best = choose_map(surface, _limits, spread);
    const MapQuality& quality = domain.best->quality;
    const bool flat = spread <= _limits.spread * degree && excess(quality, _limits) <= endurable_excess;
    const bool is_final = flat || domain.depth >= deepest_split || is_small(domain);
    if (!is_acceptable(quality, _limits) && !(is_final && is_bearable(quality))) return false;
    accept(std::move(domain.surface), std::move(domain.best->map));
    return true;
  }

  /// Whether a part of a face has room for a few elements only.
  bool is_small(const ChartDomain& domain) const {
    const double size = _field(domain.surface.points.front());
    return domain.depth > 0 && surface_area(domain.surface) < few_elements * size * size;
  }

  void split(ChartDomain domain) {
    if (domain.depth >= deepest_split) fail(domain.surface);
    for (const CutPlane& plane : propose_planes(domain.surface)) {
      std::optional<CutSurface> cut = cut_by_plane(domain.surface, plane);
      if (!cut) continue;
      std::vector<ChartSurface> parts = discretise_cuts(_model, _field, std::move(*cut), _vertices, _joined);
      for (ChartSurface& part : parts) flip_to_delaunay(part);
      push(std::move(parts), domain.depth + 1);
      return;
    }
    if (!domain.best && is_planar_domain(domain.surface))
      domain.best = choose_map(domain.surface, _limits, normal_spread(domain.surface));
    if (!domain.best || !is_bearable(domain.best->quality)) fail(domain.surface);
    accept(std::move(domain.surface), std::move(domain.best->map));
  }

  [[noreturn]] void fail(const ChartSurface& surface) const {
    const geometry::Vec3 at = surface.points.front();
    throw SurfaceError(fmt::format(
        "face {} (patch {}): no chart can be found for its part near {}, where the size is {:.4g}; where the "
        "face is rounder than that, ask for a smaller size (SizingOptions::minimum, "
        "SizingOptions::curvature_angle); else it may fold over itself: repair it in the CAD program",
        _model.face(surface.face).name, _model.patches()[_model.face(surface.face).patch],
        geometry::place_text(at), _field(at)));
  }

  const cad::Model& _model;
  const sizing::SizeField& _field;
  ChartLimits _limits;
  FaceVertices& _vertices;
  JoinedVertices _joined;
  std::vector<ChartDomain> _waiting;
  std::vector<Chart> _charts;
};

}  // namespace

std::vector<Chart> make_charts(const cad::Model& model, const sizing::SizeField& field,
                               const ChartSurface& surface, const ChartLimits& limits,
                               FaceVertices& vertices) {
  return ChartMaker(model, field, limits, vertices).run(surface);
}

std::vector<Chart> map_parts(const cad::Model& model, const sizing::SizeField& field,
                             std::vector<ChartSurface> parts, const ChartLimits& limits,
                             JoinedVertices joined, FaceVertices& vertices) {
  return ChartMaker(model, field, limits, vertices).run(std::move(parts), 1, std::move(joined));
}

}  // namespace aeroloom::surface
