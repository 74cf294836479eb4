#include "surface/charts/cut_curves.hpp"

#include "surface/charts/surface_topology.hpp"
#include "surface/curves/curve_metric.hpp"
#include "surface/curves/curve_segments.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// A point of the cut becomes a mesh vertex where the spread vertices come this close, in parts of their
/// distance.
constexpr double snap_fraction = 0.03;
/// Segments of a closed cut, at least: one more than a loop has, so that it may be round.
constexpr int least_of_closed = 4;
/// The arc of a cut over its chord, from which on one segment leaves the surface: an arc of 120 degrees.
constexpr double bulging = 1.2;

/// One stretch of a cut between mesh vertices or meetings of cuts, or a closed one: half-edges with the
/// higher part on their left.
using Chain = std::vector<geometry::HalfEdge>;

std::vector<Chain> trace_chains(const CutSurface& cut, const std::vector<geometry::HalfEdge>& twins) {
  const ChartSurface& surface = cut.surface;
  std::vector<std::int32_t> cuts_at(surface.points.size(), 0);
  std::vector<geometry::HalfEdge> next(surface.points.size(), -1);
  std::vector<geometry::HalfEdge> all;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    if (twins[h] < 0 || cut.part[h / 3] <= cut.part[twins[h] / 3]) continue;
    all.push_back(h);
    ++cuts_at[start_of(surface, h)];
    ++cuts_at[end_of(surface, h)];
    next[start_of(surface, h)] = h;
  }
  const auto is_end = [&](std::int32_t p) { return surface.mesh_vertex[p] >= 0 || cuts_at[p] != 2; };
  std::vector<char> done(twins.size(), 0);
  std::vector<Chain> chains;
  const auto follow = [&](geometry::HalfEdge start) {
    Chain chain;
    for (geometry::HalfEdge h = start; !done[h]; h = next[end_of(surface, h)]) {
      chain.push_back(h);
      done[h] = 1;
      if (is_end(end_of(surface, h))) break;
    }
    chains.push_back(std::move(chain));
  };
  for (const geometry::HalfEdge h : all) {
    if (is_end(start_of(surface, h))) follow(h);
  }
  for (const geometry::HalfEdge h : all) {
    if (!done[h]) follow(h);
  }
  return chains;
}

class CutDiscretiser {
public:
  CutDiscretiser(const cad::Model& model, const sizing::SizeField& field, CutSurface& cut,
                 FaceVertices& vertices, JoinedVertices& joined)
      : _model(model),
        _field(field),
        _cut(cut),
        _surface(cut.surface),
        _vertices(vertices),
        _joined(joined),
        _twins(geometry::match_half_edges(cut.surface.triangles)) {}

  void run() {
    for (const Chain& chain : trace_chains(_cut, _twins)) discretise(chain);
    const std::vector<std::int32_t> former = divide_edges(_surface, std::move(_divisions));
    std::vector<std::int32_t> part;
    part.reserve(former.size());
    for (const std::int32_t t : former) part.push_back(_cut.part[t]);
    _cut.part = std::move(part);
  }

private:
  void discretise(const Chain& chain) {
    const std::int32_t first = start_of(_surface, chain.front()), last = end_of(_surface, chain.back());
    const bool closed = first == last && _surface.mesh_vertex[first] < 0;
    // The start of a closed cut, and a point where cuts cross, become mesh vertices.
    if (_surface.mesh_vertex[first] < 0) promote(first, start_uv(_surface, chain.front()));
    if (_surface.mesh_vertex[last] < 0) promote(last, end_uv(_surface, chain.back()));
    std::vector<double> arc{0};
    for (const geometry::HalfEdge h : chain) arc.push_back(arc.back() + distance(start(h), end(h)));
    const MetricLength length(
        [&](double s) {
          const std::size_t k = locate(arc, s);
          return 1 / _field(start(chain[k]) + fraction(arc, k, s) * (end(chain[k]) - start(chain[k])));
        },
        {0, arc.back()});
    const int segments = count_segments(length.total(), arc.back(), first, last, closed);
    std::int32_t before = _surface.mesh_vertex[first];
    for (const double s : equal_parts(length, segments)) {
      const std::size_t k = locate(arc, s);
      const double spacing = _field(start(chain[k]));
      const std::int32_t point = place(chain[k], fraction(arc, k, s), spacing);
      join(before, _surface.mesh_vertex[point]);
      before = _surface.mesh_vertex[point];
    }
    join(before, _surface.mesh_vertex[last]);
  }

  Vec3 start(geometry::HalfEdge h) const { return _surface.points[start_of(_surface, h)]; }
  Vec3 end(geometry::HalfEdge h) const { return _surface.points[end_of(_surface, h)]; }

  static std::size_t locate(const std::vector<double>& arc, double s) {
    return static_cast<std::size_t>(std::upper_bound(arc.begin() + 1, arc.end() - 1, s) - arc.begin()) - 1;
  }
  static double fraction(const std::vector<double>& arc, std::size_t k, double s) {
    const double part = arc[k + 1] - arc[k];
    return part > 0 ? std::clamp((s - arc[k]) / part, 0.0, 1.0) : 0.5;
  }

  /// The rounded metric length, but enough that no two edges join the same vertices and a chord is near its
  /// arc: four for a closed cut, three for one that ends where it begins, two where it bulges.
  int count_segments(double metric_length, double length, std::int32_t first, std::int32_t last,
                     bool closed) const {
    const int wanted = std::max(1, static_cast<int>(std::min(std::round(metric_length), most_segments)));
    if (closed) return std::max(least_of_closed, wanted);
    const std::int32_t a = _surface.mesh_vertex[first], b = _surface.mesh_vertex[last];
    if (a == b) return std::max(least_of_loop, wanted);
    const bool bulges = length > bulging * distance(_surface.points[first], _surface.points[last]);
    return bulges || _joined.contains({std::min(a, b), std::max(a, b)}) ? std::max(2, wanted) : wanted;
  }

  void join(std::int32_t a, std::int32_t b) { _joined.insert({std::min(a, b), std::max(a, b)}); }

  /// The point for a vertex on the half-edge: one of its ends where that is near, else a new
  /// one.
  std::int32_t place(geometry::HalfEdge h, double part, double spacing) {
    const double length = distance(start(h), end(h));
    if (part * length < snap_fraction * spacing && _surface.mesh_vertex[start_of(_surface, h)] < 0) {
      promote(start_of(_surface, h), start_uv(_surface, h));
      return start_of(_surface, h);
    }
    if ((1 - part) * length < snap_fraction * spacing && _surface.mesh_vertex[end_of(_surface, h)] < 0) {
      promote(end_of(_surface, h), end_uv(_surface, h));
      return end_of(_surface, h);
    }
    const geometry::HalfEdge twin = _twins[h];
    const auto point = static_cast<std::int32_t>(_surface.points.size());
    const geometry::Vec2 uv = (1 - part) * start_uv(_surface, h) + part * end_uv(_surface, h);
    _divisions.push_back({h, part, point, uv});
    _divisions.push_back(
        {twin, 1 - part, point, part * start_uv(_surface, twin) + (1 - part) * end_uv(_surface, twin)});
    _surface.points.push_back(start(h) + part * (end(h) - start(h)));
    _surface.mesh_vertex.push_back(-1);
    promote(point, uv);
    return point;
  }

  /// Makes a point a mesh vertex on the CAD surface.
  void promote(std::int32_t point, geometry::Vec2 guess) {
    const Vec3 facet = _surface.points[point];
    guess = _model.wrap(_surface.face, guess);
    cad::Projection on = _model.project(_surface.face, facet, guess);
    const Vec3 interpolated = _model.face_point(_surface.face, guess);
    if (!(distance(on.point, facet) <= distance(interpolated, facet))) on = {guess, interpolated, true};
    _surface.points[point] = on.point;
    _surface.mesh_vertex[point] = static_cast<std::int32_t>(_vertices.points.size());
    _vertices.points.push_back(on.point);
    _vertices.uv.push_back(on.uv);
  }

  const cad::Model& _model;
  const sizing::SizeField& _field;
  CutSurface& _cut;
  ChartSurface& _surface;
  FaceVertices& _vertices;
  JoinedVertices& _joined;
  std::vector<geometry::HalfEdge> _twins;
  std::vector<EdgePoint> _divisions;
};

}  // namespace

JoinedVertices joined_vertices(const ChartSurface& surface) {
  JoinedVertices joined;
  for (const auto& [a, b] : surface.loop_edges) {
    joined.insert({std::min(surface.mesh_vertex[a], surface.mesh_vertex[b]),
                   std::max(surface.mesh_vertex[a], surface.mesh_vertex[b])});
  }
  return joined;
}

std::vector<ChartSurface> discretise_cuts(const cad::Model& model, const sizing::SizeField& field,
                                          CutSurface cut, FaceVertices& vertices, JoinedVertices& joined) {
  CutDiscretiser(model, field, cut, vertices, joined).run();
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(cut.surface.triangles);
  std::vector<std::int32_t> component;
  const std::int32_t count = label_components(twins, cut.part, component);
  return separate_parts(cut.surface, twins, component, count);
}

}  // namespace aeroloom::surface
