#include <algorithm>

#include "surface/face_remesher.hpp"

namespace aeroloom::surface {
namespace {

constexpr double shortest_edge = 0.65, longest_edge = 1.4;  // in sizes
/// Triangles below this mean ratio are worth contracting an edge whatever its length.
constexpr double poor_mean_ratio = 0.55;

}  // namespace

bool FaceRemesher::is_contraction_wanted(HalfEdge edge) const {
  const double length = edge_length(edge);
  if (length < shortest_edge * edge_size(edge)) return true;
  const HalfEdge next = half_edge(triangle_of(edge), next_corner(corner_of(edge)));
  const HalfEdge previous = half_edge(triangle_of(edge), previous_corner(corner_of(edge)));
  return length < edge_length(next) && length < edge_length(previous) &&
         shape(triangle_of(edge)).mean_ratio < poor_mean_ratio;
}

void FaceRemesher::contract_short_edges() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
    for (int i = 0; i < 3 && is_live(t); ++i) {
      const HalfEdge edge = half_edge(t, i);
      if (_links.mate(edge) != no_half_edge && is_edge_active(edge) && is_contraction_wanted(edge)) contract(edge);
    }
  }
}

/// Tries the middle, then either end.
bool FaceRemesher::contract(HalfEdge edge) {
  const HalfEdge other = _links.mate(edge);
  const std::int32_t a = _links.origin(edge), b = _links.target(edge);
  if (is_free(a) && is_free(b)) {
    Place middle;
    const double length = edge_length(edge);
    if (project(0.5 * (_mesh.points[a] + _mesh.points[b]), b, 0.5 * length, middle) && try_contraction(edge, middle)) {
      return true;
    }
  }
  return (is_free(a) && try_contraction(edge, place_of(b))) || (is_free(b) && try_contraction(other, place_of(a)));
}

/// Contracts the edge's origin into its target, both coming to lie at `place`, if that is acceptable.
bool FaceRemesher::try_contraction(HalfEdge edge, const Place& place) {
  const std::int32_t gone = _links.origin(edge), kept = _links.target(edge);
  const std::int32_t t = triangle_of(edge), u = triangle_of(_links.mate(edge));
  if (!keeps_topology(edge)) return false;
  _links.gather_fan(kept, _other_fan);
  PatchShape before, after;
  const auto add = [&](const std::vector<std::int32_t>& fan, std::int32_t vertex) {
    bool short_enough = true;
    for (const std::int32_t s : fan) {
      before.add(shape(s));
      if (s == t || s == u) continue;
      after.add(shape_with(s, vertex, place));
      for (const std::int32_t v : _links.triangles[s].vertices) {
        const double limit = longest_edge * 0.5 * (_sizes[v] + place.size);
        if (v != vertex && distance(_mesh.points[v], place.point) > limit) short_enough = false;
      }
    }
    return short_enough;
  };
  const bool fan_short = add(_fan, gone), other_fan_short = add(_other_fan, kept);
  const bool improves = after.mean_ratio > before.mean_ratio && before.mean_ratio < poor_mean_ratio;
  if (!is_acceptable(before, after) || !((fan_short && other_fan_short) || improves)) return false;
  _links.contract(edge);
  put(kept, place);
  note_change(kept);
  return true;
}

/// Whether the surface stays a manifold: the ends have no common neighbours but the two apexes. Leaves the origin's
/// fan in `_fan`.
bool FaceRemesher::keeps_topology(HalfEdge edge) {
  const std::int32_t gone = _links.origin(edge), kept = _links.target(edge);
  const std::int32_t c = _links.apex(edge), d = _links.apex(_links.mate(edge));
  if (!_links.gather_fan(gone, _fan) || _fan.size() < 3 || c == d) return false;
  const HalfEdge beyond = _links.triangles[triangle_of(edge)].links[next_corner(corner_of(edge))];
  const bool tetrahedron = _fan.size() == 3 && beyond != no_half_edge && _links.apex(beyond) == d;
  if (tetrahedron) return false;
  for (const std::int32_t t : _fan) {
    const int k = _links.corner(t, gone);
    const std::int32_t w = _links.triangles[t].vertices[next_corner(k)];
    if (w == kept || w == c || w == d) continue;
    if (_links.find(w, kept) != no_half_edge || _links.find(kept, w) != no_half_edge) return false;
  }
  return true;
}

void FaceRemesher::divide_long_edges() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
    for (int i = 0; i < 3 && is_live(t); ++i) {
      const HalfEdge edge = half_edge(t, i);
      if (_links.mate(edge) == no_half_edge || !is_edge_active(edge)) continue;
      if (edge_length(edge) > longest_edge * edge_size(edge)) divide(edge);
    }
  }
}

/// Puts a vertex on the surface next to the middle of the edge. The guess is one end's parameters, not the mean of
/// both: they may lie on different sides of a seam.
void FaceRemesher::divide(HalfEdge edge) {
  const HalfEdge other = _links.mate(edge);
  const std::int32_t a = _links.apex(edge), b = _links.origin(edge), c = _links.target(edge), d = _links.apex(other);
  Place middle;
  if (!project(0.5 * (_mesh.points[b] + _mesh.points[c]), b, 0.5 * edge_length(edge), middle)) return;
  PatchShape before = shape(a, b, c), after;
  before.add(shape(d, c, b));
  const Place pa = place_of(a), pb = place_of(b), pc = place_of(c), pd = place_of(d);
  for (const auto& corners : {std::array{pa, pb, middle}, {pa, middle, pc}, {pd, pc, middle}, {pd, middle, pb}}) {
    after.add(shape(corners));
  }
  if (!is_acceptable(before, after)) return;
  const std::int32_t vertex = _links.divide(edge);
  _mesh.points.emplace_back();
  _mesh.uv.emplace_back();
  _normals.emplace_back();
  _sizes.emplace_back();
  _movable.push_back(1);
  _active.push_back(1);
  _next.push_back(1);
  put(vertex, middle);
  note_change(vertex);
}

}  // namespace aeroloom::surface
