#include "surface/charts/chart_division.hpp"

#include "geometry/half_edges.hpp"
#include "geometry/predicates.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/plane_cut.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/front/edge_crossings.hpp"
#include "surface/surface_error.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <utility>

namespace aeroloom::surface {
namespace {

using geometry::HalfEdge;

/// The border of a chart, edge by edge.
struct FineBorder {
  front::FrontInput input;          // all points of the chart, and the edges of its border
  std::vector<std::int32_t> chord;  // per edge: the loop edge that it belongs to, -1: none
};

FineBorder border_of(const Chart& chart) {
  const ChartSurface& surface = chart.surface;
  std::vector<std::int32_t> chord_from(surface.points.size(), -1);
  for (std::size_t e = 0; e < surface.loop_edges.size(); ++e)
    chord_from[surface.loop_edges[e][0]] = static_cast<std::int32_t>(e);
  FineBorder border{{chart.plane, {}}, {}};
  for (const auto& loop : trace_boundary(surface, geometry::match_half_edges(surface.triangles))) {
    const auto begins_chord = [&](HalfEdge h) { return surface.mesh_vertex[start_of(surface, h)] >= 0; };
    const auto first = std::find_if(loop.begin(), loop.end(), begins_chord);
    std::int32_t chord = -1;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t begin = first == loop.end() ? 0 : static_cast<std::size_t>(first - loop.begin());
      const HalfEdge h = loop[(begin + i) % loop.size()];
      if (begins_chord(h)) chord = chord_from[start_of(surface, h)];
      border.input.edges.push_back({start_of(surface, h), end_of(surface, h)});
      border.chord.push_back(chord);
    }
  }
  return border;
}

/// Whether two points are one place in space: loops may touch there.
bool is_one_vertex(const ChartSurface& surface, std::int32_t a, std::int32_t b) {
  return a == b || (surface.mesh_vertex[a] >= 0 && surface.mesh_vertex[a] == surface.mesh_vertex[b]);
}

bool have_common_vertex(const ChartSurface& surface, const BorderMeeting& meeting) {
  for (const std::int32_t a : meeting.edges[0]) {
    for (const std::int32_t b : meeting.edges[1]) {
      if (is_one_vertex(surface, a, b)) return true;
    }
  }
  return false;
}

/// Whether a triangle at the ends of one of the chords is turned over.
bool is_turned_beside(const Chart& chart, const std::vector<std::array<std::int32_t, 2>>& chords) {
  std::vector<char> beside(chart.surface.points.size(), 0);
  for (const auto& pair : chords) {
    for (const std::int32_t e : pair) {
      for (const std::int32_t p : chart.surface.loop_edges[e]) beside[p] = 1;
    }
  }
  return std::any_of(chart.surface.triangles.begin(), chart.surface.triangles.end(), [&](const auto& t) {
    return (beside[t[0]] != 0 || beside[t[1]] != 0 || beside[t[2]] != 0) &&
           geometry::orient2d(chart.plane[t[0]], chart.plane[t[1]], chart.plane[t[2]]) < 0;
  });
}

/// Per point, the way over edges to the nearest of two points.
std::vector<double> ways_over_edges(const ChartSurface& surface, const std::array<std::int32_t, 2>& from) {
  std::vector<std::vector<std::int32_t>> beside(surface.points.size());
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(3 * surface.triangles.size()); ++h) {
    beside[start_of(surface, h)].push_back(end_of(surface, h));
    beside[end_of(surface, h)].push_back(start_of(surface, h));
  }
  using Entry = std::pair<double, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> way(surface.points.size(), std::numeric_limits<double>::infinity());
  for (const std::int32_t p : from) {
    way[p] = 0;
    queue.emplace(0.0, p);
  }
  while (!queue.empty()) {
    const auto [length, p] = queue.top();
    queue.pop();
    if (length > way[p]) continue;
    for (const std::int32_t q : beside[p]) {
      const double longer = length + distance(surface.points[p], surface.points[q]);
      if (longer >= way[q]) continue;
      way[q] = longer;
      queue.emplace(longer, q);
    }
  }
  return way;
}

/// The cuts to try, the best first: along the medial line, then planes.
class FoldCuts {
public:
  FoldCuts(const ChartSurface& surface, const ChartFold& fold) : _surface(surface), _fold(fold) {}

  std::optional<CutSurface> next() {
    std::optional<CutSurface> cut;
    if (_tried == 0) {
      if (_fold.meeting) cut = cut_by_levels(_surface, medial_levels(_surface, *_fold.meeting));
      _planes = propose_planes(_surface);
      ++_tried;
    }
    while (!cut && _tried <= _planes.size()) cut = cut_by_plane(_surface, _planes[_tried++ - 1]);
    return cut;
  }

private:
  const ChartSurface& _surface;
  const ChartFold& _fold;
  std::vector<CutPlane> _planes;
  std::size_t _tried = 0;  // the line, then planes
};

}  // namespace

std::optional<ChartFold> find_fold(const Chart& chart,
                                   const std::vector<std::array<std::int32_t, 2>>& chords) {
  const FineBorder border = border_of(chart);
  std::set<std::array<std::int32_t, 2>> looked_for;
  for (const auto& [first, second] : chords)
    looked_for.insert({std::min(first, second), std::max(first, second)});
  for (const front::CrossingEdges& crossing : front::find_edge_crossings(border.input)) {
    const std::int32_t a = border.chord[crossing.first], b = border.chord[crossing.second];
    if (!chords.empty() && !looked_for.contains({std::min(a, b), std::max(a, b)})) continue;
    const BorderMeeting meeting{{border.input.edges[crossing.first], border.input.edges[crossing.second]}};
    if (!have_common_vertex(chart.surface, meeting)) return ChartFold{meeting};
  }
  if (chords.empty() || is_turned_beside(chart, chords)) return ChartFold{};
  return std::nullopt;
}

std::vector<double> medial_levels(const ChartSurface& surface, const BorderMeeting& meeting) {
  std::vector<double> levels = ways_over_edges(surface, meeting.edges[0]);
  const std::vector<double> other = ways_over_edges(surface, meeting.edges[1]);
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = 0.5 * (levels[i] - other[i]);
  return levels;
}

std::vector<Chart> divide_chart(const cad::Model& model, const sizing::SizeField& field,
                                const FoldedChart& folded, const ChartLimits& limits,
                                const JoinedVertices& joined, FaceVertices& vertices) {
  const std::size_t before = vertices.points.size();
  FoldCuts cuts(folded.chart.surface, folded.fold);
  while (std::optional<CutSurface> cut = cuts.next()) {
    JoinedVertices now = joined;
    try {
      std::vector<ChartSurface> parts = discretise_cuts(model, field, std::move(*cut), vertices, now);
      for (ChartSurface& part : parts) flip_to_delaunay(part);
      return map_parts(model, field, std::move(parts), limits, std::move(now), vertices);
    } catch (const SurfaceError&) {  // a part has no chart: another cut may be better
      vertices.points.resize(before);
      vertices.uv.resize(before);
    }
  }
  return {};
}

}  // namespace aeroloom::surface
