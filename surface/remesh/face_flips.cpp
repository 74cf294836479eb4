#include "surface/remesh/face_remesher.hpp"
#include "surface/remesh/triangle_angle.hpp"

#include <algorithm>

namespace aeroloom::surface {

/// Squared sine of the smallest angle.
double FaceRemesher::smallest_sine(std::int32_t a, std::int32_t b, std::int32_t c) const {
  return smallest_squared_sine(_mesh.points[a], _mesh.points[b], _mesh.points[c]);
}

/// Flips where the smaller angle of the two triangles gets larger and nothing else worse.
bool FaceRemesher::flip_if_better(geometry::LinkedEdge edge) {
  const geometry::LinkedEdge other = _links.twin(edge);
  if (other == geometry::no_linked_edge) return false;
  const std::int32_t a = _links.apex(edge), b = _links.origin(edge), c = _links.target(edge),
                     d = _links.apex(other);
  // Two acute angles face the edge: they add up to less than 180 degrees, and the edge is the better
  // diagonal.
  const geometry::Vec3 pa = _mesh.points[a], pb = _mesh.points[b], pc = _mesh.points[c], pd = _mesh.points[d];
  if (dot(pb - pa, pc - pa) > 0 && dot(pb - pd, pc - pd) > 0) return false;
  const double sine = std::min(smallest_sine(a, b, c), smallest_sine(d, c, b));
  const double flipped_sine = std::min(smallest_sine(a, b, d), smallest_sine(d, c, a));
  constexpr double real_gain = 1 + 1e-6;  // more than rounding: no flip is undone by the next
  if (!(flipped_sine > sine * real_gain) || a == d) return false;
  TriangleShapes before = shape(a, b, c), after = shape(a, b, d);
  before.add(shape(d, c, b));
  after.add(shape(d, c, a));
  if (after.mean_ratio < before.mean_ratio || !is_acceptable(before, after)) return false;
  if (_links.find(a, d) != geometry::no_linked_edge || _links.find(d, a) != geometry::no_linked_edge)
    return false;
  _links.flip(edge);
  for (const std::int32_t v : {a, b, c, d}) _next[v] = 1;
  return true;
}

void FaceRemesher::flip_edges() {
  for (std::int32_t start = 0; start < static_cast<std::int32_t>(_links.triangles.size()); ++start) {
    if (!is_live(start)) continue;
    for (int i = 0; i < 3; ++i) {
      const geometry::LinkedEdge edge = geometry::linked_edge(start, i);
      if (_links.twin(edge) > edge && is_edge_active(edge)) _stack.push_back(edge);
      while (!_stack.empty()) {
        const geometry::LinkedEdge next = _stack.back();
        _stack.pop_back();
        const geometry::LinkedEdge other = _links.twin(next);
        if (!flip_if_better(next)) continue;
        const std::int32_t t = geometry::triangle_of(next), u = geometry::triangle_of(other);
        _stack.insert(_stack.end(), {geometry::linked_edge(t, 0), geometry::linked_edge(t, 2),
                                     geometry::linked_edge(u, 0), geometry::linked_edge(u, 2)});
      }
    }
  }
}

}  // namespace aeroloom::surface
