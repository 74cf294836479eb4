#include "surface/front/front.hpp"

#include "surface/front/boundary_triangulation.hpp"
#include "surface/front/delaunay.hpp"
#include "surface/front/plane_smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::front {
namespace {

using geometry::Vec2;

/// A triangle needs no further point when its circumradius, in sizes, is at most this; an ideal one has
/// 0.577.
constexpr double accepted_radius = 0.88;
/// No edge of an accepted triangle is longer than this, in sizes: a triangle may be slender within its
/// radius. Chosen, not measured.
constexpr double accepted_edge = 1.6;
/// No new point comes closer than this to another one, in sizes. Chosen, not measured.
constexpr double smallest_distance = 0.6;
/// Sizes grow at most so fast away from boundary edges that are shorter than asked for. Chosen, not measured.
constexpr double short_edge_growth = 0.4;
constexpr int smoothing_sweeps = 4;
// Beside a boundary edge that is longer than the size, which nobody may divide: the triangle on it is as good
// as it gets when its radius is that of the edge, and its free edges go so far to meet the size. The least
// spacing is that of the lowest apex that still is one, and twice the edge the highest.
constexpr double radius_of_fixed = 0.95, edge_of_fixed = 0.55, least_spacing = 0.55, most_spacing = 2;
/// A spacing that changes by less when the size at the point is known is not placed again.
constexpr double same_spacing = 0.01;
/// No point is nearer to a boundary edge, in its length or the spacing: a little less than half the height of
/// an equilateral triangle. The numbers of the front were chosen, not measured one by one.
constexpr double least_height = 0.4;

/// A front edge: accepted or boundary on its right, to be filled on its left.
struct FrontEdge {
  std::int32_t origin, target;
};

/// A place for a point.
struct Candidate {
  Vec2 point;
  double spacing;  ///< edge length asked for around it
  double size;     ///< at the point
  std::int32_t hint;
};

/// The front moves from the boundary inwards, first come first served, so it advances layer by layer.
class Front {
public:
  Front(Delaunay& plane, const FrontInput& boundary, const ChartSize& size)
      : _plane(plane), _mesh(plane.mesh), _size(size) {
    measure_boundary(boundary);
    for (auto& triangle : _mesh.triangles) assess(triangle);
    for (const auto& [a, b] : boundary.edges) offer(_mesh.find(a, b));
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_mesh.triangles.size()); ++t) offer_edges(t);
  }

  void fill() {
    do advance();
    while (refine_rest());
  }

private:
  void measure_boundary(const FrontInput& boundary);
  void assess(geometry::LinkedTriangle& triangle) const;
  void offer(geometry::LinkedEdge edge);
  void offer_edges(std::int32_t t);
  void advance();
  bool refine_rest();
  bool place_ideal(geometry::LinkedEdge edge, Candidate& best);
  bool place_centre(std::int32_t t, Candidate& best);
  bool insert(const Candidate& candidate, std::int32_t seed);
  bool is_clear(const Candidate& candidate) const;
  double wanted_size(Vec2 point, std::int32_t& hint) const {
    const double size = _size(point, hint);
    if (!(size > 0))
      throw std::invalid_argument("the size function of a chart gives a size that is not positive");
    return size;
  }
  double size_at(Vec2 point, double neighbour_size, double distance, std::int32_t& hint) const {
    return std::min(wanted_size(point, hint), neighbour_size + short_edge_growth * distance);
  }

  Delaunay& _plane;
  geometry::TriangleLinks& _mesh;
  const ChartSize& _size;
  std::vector<double> _sizes;        // per vertex
  std::vector<std::int32_t> _hints;  // per vertex
  std::vector<FrontEdge> _queue;
  std::size_t _head = 0;
};

void Front::measure_boundary(const FrontInput& boundary) {
  const std::size_t count = boundary.points.size();
  std::vector<double> length(count, 0.0);
  std::vector<int> edges(count, 0);
  for (const auto& [a, b] : boundary.edges) {
    for (const std::int32_t v : {a, b}) {
      length[v] += distance(boundary.points[a], boundary.points[b]);
      ++edges[v];
    }
  }
  _sizes.assign(_plane.points.size(), 0.0);
  _hints.assign(_plane.points.size(), 0);
  std::int32_t hint = 0;
  for (std::size_t v = 0; v < count; ++v) {
    _sizes[v] = wanted_size(boundary.points[v], hint);
    if (edges[v] > 0) _sizes[v] = std::min(_sizes[v], 2 * length[v] / edges[v]);
    _hints[v] = hint;
  }
}

/// Decides whether a triangle of the region is to be kept.
void Front::assess(geometry::LinkedTriangle& triangle) const {
  if (state_of(triangle) == TriangleState::outside) return;
  const auto& v = triangle.vertices;
  const Vec2 p[3] = {_plane.points[v[0]], _plane.points[v[1]], _plane.points[v[2]]};
  double product = 1, longest_free = 0, longest_fixed = 0;  // of squared lengths
  for (int i = 0; i < 3; ++i) {
    const Vec2 edge = p[geometry::previous_corner(i)] - p[geometry::next_corner(i)];
    const double squared = dot(edge, edge);
    product *= squared;
    double& longest = triangle.flags >> i & 1u ? longest_fixed : longest_free;
    longest = std::max(longest, squared);
  }
  const double size = (_sizes[v[0]] + _sizes[v[1]] + _sizes[v[2]]) / 3, fixed = std::sqrt(longest_fixed);
  const double area2 = cross(p[1] - p[0], p[2] - p[0]);
  const double radius_limit = accepted_radius * std::max(size, radius_of_fixed * fixed);
  const double edge_limit = accepted_edge * std::max(size, edge_of_fixed * fixed);
  const bool accepted =
      product <= 4 * area2 * area2 * radius_limit * radius_limit && longest_free <= edge_limit * edge_limit;
  set_state(triangle, accepted ? TriangleState::accepted : TriangleState::waiting);
}

/// Queues the edge when its triangle waits and the neighbour does not.
void Front::offer(geometry::LinkedEdge edge) {
  if (state_of(_mesh.triangles[geometry::triangle_of(edge)]) != TriangleState::waiting ||
      _mesh.is_tagged(edge))
    return;
  const geometry::LinkedEdge other = _mesh.twin(edge);
  if (!_mesh.is_fixed(edge) &&
      state_of(_mesh.triangles[geometry::triangle_of(other)]) != TriangleState::accepted)
    return;
  _mesh.set_tagged(edge, true);
  _queue.push_back({_mesh.origin(edge), _mesh.target(edge)});
}

/// Offers the edges of a triangle from both sides.
void Front::offer_edges(std::int32_t t) {
  const TriangleState state = state_of(_mesh.triangles[t]);
  if (state == TriangleState::outside) return;
  for (int i = 0; i < 3; ++i) {
    const geometry::LinkedEdge edge = geometry::linked_edge(t, i);
    if (state == TriangleState::waiting) {
      offer(edge);
    } else if (!_mesh.is_fixed(edge)) {
      offer(_mesh.twin(edge));
    }
  }
}

void Front::advance() {
  for (; _head < _queue.size(); ++_head) {
    const geometry::LinkedEdge edge = _mesh.find(_queue[_head].origin, _queue[_head].target);
    if (edge == geometry::no_linked_edge) continue;
    _mesh.set_tagged(edge, false);
    if (state_of(_mesh.triangles[geometry::triangle_of(edge)]) != TriangleState::waiting) continue;
    Candidate candidate;
    if (place_ideal(edge, candidate)) insert(candidate, geometry::triangle_of(edge));
  }
  _queue.clear();
  _head = 0;
}

/// The point that makes a triangle of the wanted edge length over a front edge, but no further than the
/// circumcentre of the triangle there: on this segment the edge's ends are the nearest vertices (Rebay).
bool Front::place_ideal(geometry::LinkedEdge edge, Candidate& best) {
  const std::int32_t va = _mesh.origin(edge), vb = _mesh.target(edge);
  const Vec2 a = _plane.points[va], b = _plane.points[vb], middle = 0.5 * (a + b);
  const double length = distance(a, b), half = 0.5 * length;
  const Vec2 normal = Vec2{a.y - b.y, b.x - a.x} / length;
  const Vec2 apex = _plane.points[_mesh.apex(edge)] - middle;
  const double center_height = (dot(apex, apex) - half * half) / (2 * dot(apex, normal));
  if (!(center_height > 0)) return false;

  const double edge_size = 0.5 * (_sizes[va] + _sizes[vb]);
  const auto spacing_for = [&](double size) {
    return std::clamp(size, least_spacing * length, most_spacing * length);
  };
  const auto place = [&](double spacing) {
    // Leaning towards equal areas: where the front's edges have got shorter than wanted, it moves in longer
    // steps.
    const double step = std::sqrt((spacing * spacing - half * half) * std::sqrt(spacing / length));
    const double height = std::min(step, center_height);
    best.spacing = spacing;
    best.point = middle + height * normal;
    best.size = size_at(best.point, edge_size, height, best.hint);
  };
  best.hint = _hints[va];
  place(spacing_for(edge_size));
  // The wanted length is that between the edge and the new point; a second look where sizes change.
  const double spacing = spacing_for(0.5 * (edge_size + best.size));
  if (std::abs(spacing - best.spacing) > same_spacing * spacing) place(spacing);
  return true;
}

bool Front::place_centre(std::int32_t t, Candidate& best) {
  const auto& v = _mesh.triangles[t].vertices;
  const Vec2 a = _plane.points[v[0]], b = _plane.points[v[1]] - a, c = _plane.points[v[2]] - a;
  const double bb = dot(b, b), cc = dot(c, c), area2 = 2 * cross(b, c);
  const Vec2 offset{(c.y * bb - b.y * cc) / area2, (b.x * cc - c.x * bb) / area2};
  if (!(std::isfinite(offset.x) && std::isfinite(offset.y))) return false;
  best.point = a + offset;
  best.hint = _hints[v[0]];
  best.size = size_at(best.point, (_sizes[v[0]] + _sizes[v[1]] + _sizes[v[2]]) / 3, norm(offset), best.hint);
  best.spacing = best.size;
  return true;
}

/// Whether the candidate keeps its distance from vertices and boundary edges around it.
bool Front::is_clear(const Candidate& candidate) const {
  const double limit = smallest_distance * candidate.spacing;
  for (const auto& edge : _plane.cavity()) {
    const Vec2 a = _plane.points[edge.origin], b = _plane.points[edge.target];
    const Vec2 offset = candidate.point - a;
    if (dot(offset, offset) < limit * limit) return false;
    if (edge.flags & 1u) {
      const double length = distance(a, b), height = cross(b - a, offset) / length;
      if (height < least_height * std::min(candidate.spacing, length)) return false;
    }
  }
  return true;
}

bool Front::insert(const Candidate& candidate, std::int32_t seed) {
  if (!_plane.find_cavity(candidate.point, seed) || !is_clear(candidate)) return false;
  _plane.fill_cavity();
  _sizes.push_back(candidate.size);
  _hints.push_back(candidate.hint);
  for (const std::int32_t t : _plane.created()) assess(_mesh.triangles[t]);
  for (const std::int32_t t : _plane.created()) offer_edges(t);
  return true;
}

/// Inserts circumcentres of triangles the front has left behind. True when that opened a new front.
bool Front::refine_rest() {
  bool changed = false;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_mesh.triangles.size()); ++t) {
    Candidate candidate;
    if (state_of(_mesh.triangles[t]) != TriangleState::waiting || !place_centre(t, candidate)) continue;
    changed = insert(candidate, t) || changed;
  }
  return changed;
}

/// The triangles of the region, without the vertices of the box around it.
FrontResult extract(const Delaunay& plane, std::int32_t given) {
  FrontResult result;
  result.points.assign(plane.points.begin(), plane.points.begin() + given);
  result.points.insert(result.points.end(), plane.points.begin() + given + box_corners, plane.points.end());
  for (const auto& triangle : plane.mesh.triangles) {
    if (state_of(triangle) == TriangleState::outside) continue;
    auto& t = result.triangles.emplace_back(triangle.vertices);
    for (std::int32_t& v : t) v -= v >= given ? box_corners : 0;
  }
  return result;
}

}  // namespace

FrontResult fill_front(const FrontInput& input, const ChartSize& size) {
  Delaunay plane = triangulate_region(input);
  const auto given = static_cast<std::int32_t>(input.points.size());
  Front front(plane, input, size);
  front.fill();
  smooth_plane(plane, given + box_corners, smoothing_sweeps);
  return extract(plane, given);
}

}  // namespace aeroloom::front
