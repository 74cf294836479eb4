#include "surface/remesh/face_remesher.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::surface {
namespace {

// In sizes: an edge that is divided at 1.4 leaves two of 0.7, which are not contracted again.
constexpr double shortest_edge = 0.65, longest_edge = 1.4;
/// Edges of the star around a new vertex: beyond ten its triangles have angles of 36 degrees and less.
constexpr std::size_t most_star_edges = 10;
/// Triangles below this mean ratio are worth contracting an edge whatever its length. Chosen, not measured.
constexpr double poor_mean_ratio = 0.55;

}  // namespace

bool FaceRemesher::is_contraction_wanted(geometry::LinkedEdge edge) const {
  const double length = edge_length(edge);
  if (length < shortest_edge * edge_size(edge)) return true;
  const geometry::LinkedEdge next =
      geometry::linked_edge(geometry::triangle_of(edge), geometry::next_corner(geometry::corner_of(edge)));
  const geometry::LinkedEdge previous = geometry::linked_edge(
      geometry::triangle_of(edge), geometry::previous_corner(geometry::corner_of(edge)));
  return length < edge_length(next) && length < edge_length(previous) &&
         shape(geometry::triangle_of(edge)).mean_ratio < poor_mean_ratio;
}

void FaceRemesher::contract_short_edges() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
    for (int i = 0; i < 3 && is_live(t); ++i) {
      const geometry::LinkedEdge edge = geometry::linked_edge(t, i);
      if (_links.twin(edge) != geometry::no_linked_edge && is_edge_active(edge) &&
          is_contraction_wanted(edge))
        contract(edge);
    }
  }
}

/// Tries the middle, then either end.
bool FaceRemesher::contract(geometry::LinkedEdge edge) {
  const geometry::LinkedEdge other = _links.twin(edge);
  const std::int32_t a = _links.origin(edge), b = _links.target(edge);
  if (is_free(a) && is_free(b)) {
    VertexPlace middle;
    const double length = edge_length(edge);
    if (project(0.5 * (_mesh.points[a] + _mesh.points[b]), b, 0.5 * length, middle) &&
        try_contraction(edge, middle)) {
      return true;
    }
  }
  return (is_free(a) && try_contraction(edge, place_of(b))) ||
         (is_free(b) && try_contraction(other, place_of(a)));
}

/// Contracts the edge's origin into its target, both coming to lie at `place`, if that is acceptable.
bool FaceRemesher::try_contraction(geometry::LinkedEdge edge, const VertexPlace& place) {
  const std::int32_t gone = _links.origin(edge), kept = _links.target(edge);
  const std::int32_t t = geometry::triangle_of(edge), u = geometry::triangle_of(_links.twin(edge));
  if (!keeps_topology(edge)) return false;
  _links.gather_fan(kept, _other_fan);
  TriangleShapes before, after;
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

/// Whether the surface stays a manifold: the ends have no common neighbours but the two apexes. Leaves the
/// origin's fan in `_fan`.
bool FaceRemesher::keeps_topology(geometry::LinkedEdge edge) {
  const std::int32_t gone = _links.origin(edge), kept = _links.target(edge);
  const std::int32_t c = _links.apex(edge), d = _links.apex(_links.twin(edge));
  if (!_links.gather_fan(gone, _fan) || _fan.size() < 3 || c == d) return false;
  const geometry::LinkedEdge neighbour =
      _links.triangles[geometry::triangle_of(edge)].links[geometry::next_corner(geometry::corner_of(edge))];
  const bool tetrahedron =
      _fan.size() == 3 && neighbour != geometry::no_linked_edge && _links.apex(neighbour) == d;
  if (tetrahedron) return false;
  for (const std::int32_t t : _fan) {
    const int k = _links.corner(t, gone);
    const std::int32_t w = _links.triangles[t].vertices[geometry::next_corner(k)];
    if (w == kept || w == c || w == d) continue;
    if (_links.find(w, kept) != geometry::no_linked_edge || _links.find(kept, w) != geometry::no_linked_edge)
      return false;
  }
  return true;
}

/// The vertices there are, and for each edge the square of its length in sizes: seven times as many where all
/// edges have the length they should.
std::size_t FaceRemesher::bound_vertices() const {
  double bound = static_cast<double>(_mesh.points.size());
  for (const auto& [a, b, c] : _mesh.triangles) {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      const double length = distance(_mesh.points[from], _mesh.points[to]);
      bound += std::pow(length / std::min(_sizes[from], _sizes[to]), 2);
    }
  }
  return static_cast<std::size_t>(std::min(bound, 1e9));
}

void FaceRemesher::divide_long_edges() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
    for (int i = 0; i < 3 && is_live(t); ++i) {
      const geometry::LinkedEdge edge = geometry::linked_edge(t, i);
      if (_links.twin(edge) == geometry::no_linked_edge || !is_edge_active(edge)) continue;
      if (_mesh.points.size() >= _most_vertices) return;
      if (edge_length(edge) > longest_edge * edge_size(edge)) divide(edge);
    }
  }
}

/// Puts a vertex on the surface next to the middle of the edge, and joins it to what lies around if that is
/// better than the edge's own two triangles divided. The guess is one end's parameters, not the mean of both:
/// they may lie on different sides of a seam.
void FaceRemesher::divide(geometry::LinkedEdge edge) {
  const std::int32_t b = _links.origin(edge), c = _links.target(edge);
  VertexPlace middle;
  if (!project(0.5 * (_mesh.points[b] + _mesh.points[c]), b, 0.5 * edge_length(edge), middle)) return;
  TriangleShapes before = shape(geometry::triangle_of(edge)), after;
  before.add(shape(geometry::triangle_of(_links.twin(edge))));
  plan_star(edge, middle, before, after);
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
  for (const StarEdge& replaced : _replaced) _links.flip(_links.find(replaced.origin, replaced.target));
  note_change(vertex);
}

/// Starts from the four triangles of the divided edge and takes in their neighbours as long as that makes
/// better ones.
void FaceRemesher::plan_star(geometry::LinkedEdge edge, const VertexPlace& middle, TriangleShapes& before,
                             TriangleShapes& after) {
  _replaced.clear();
  _star.clear();
  for (const geometry::LinkedEdge side : {edge, _links.twin(edge)}) {
    const std::int32_t t = geometry::triangle_of(side);
    for (const int i : {geometry::next_corner(geometry::corner_of(side)),
                        geometry::previous_corner(geometry::corner_of(side))}) {
      const geometry::LinkedEdge e = geometry::linked_edge(t, i);
      _star.push_back({_links.origin(e), _links.target(e), _links.twin(e)});
    }
  }
  const auto triangle = [&](std::int32_t a, std::int32_t b) {
    return shape({place_of(a), place_of(b), middle});
  };
  const auto is_in_star = [&](std::int32_t v) {
    return std::any_of(_star.begin(), _star.end(), [&](const StarEdge& e) { return e.origin == v; });
  };
  for (std::size_t k = 0; k < _star.size() && _star.size() < most_star_edges;) {
    const StarEdge e = _star[k];
    const std::int32_t w = e.outside == geometry::no_linked_edge ? -1 : _links.apex(e.outside);
    if (w < 0 || is_in_star(w)) {
      ++k;
      continue;
    }
    const TriangleShapes neighbour = shape(geometry::triangle_of(e.outside));
    TriangleShapes old = neighbour, joined = triangle(e.origin, w);
    old.add(triangle(e.origin, e.target));
    joined.add(triangle(w, e.target));
    if (!(joined.mean_ratio > old.mean_ratio && is_acceptable(old, joined))) {
      ++k;
      continue;
    }
    before.add(neighbour);
    // Seen from the neighbour, the edge runs from its target to its origin, then to w.
    const std::int32_t t = geometry::triangle_of(e.outside);
    const int j = geometry::corner_of(e.outside);
    _replaced.push_back(e);
    _star[k] = {e.origin, w, _links.triangles[t].links[geometry::next_corner(j)]};
    _star.push_back({w, e.target, _links.triangles[t].links[geometry::previous_corner(j)]});
  }
  for (const StarEdge& e : _star) after.add(triangle(e.origin, e.target));
}

}  // namespace aeroloom::surface
