#include "geometry/triangle_links.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::geometry {
namespace {

/// Flag bits of one edge, moved to corner 0.
std::uint32_t edge_bits(const LinkedTriangle& triangle, int corner) {
  return triangle.flags >> corner & 0b1001u;
}

constexpr std::uint32_t all_edge_bits = 0b111111u;

}  // namespace

void TriangleLinks::build(const std::vector<std::array<std::int32_t, 3>>& triples,
                          std::int32_t vertex_count) {
  struct OpenEdge {
    std::int32_t high;
    LinkedEdge edge;
  };
  triangles.assign(triples.size(), {});
  triangle_at.assign(vertex_count, -1);
  std::vector<std::int32_t> begin(vertex_count + 1,
                                  0);  // of the sides at each vertex, which is their lower end
  const auto lower = [&](std::int32_t t, int i) {
    return std::min(triples[t][next_corner(i)], triples[t][previous_corner(i)]);
  };
  const auto count = static_cast<std::int32_t>(triples.size());
  for (std::int32_t t = 0; t < count; ++t) {
    triangles[t].vertices = triples[t];
    for (int i = 0; i < 3; ++i) {
      triangle_at[triples[t][i]] = t;
      ++begin[lower(t, i) + 1];
    }
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<OpenEdge> sides(3 * triples.size());
  std::vector<std::int32_t> end(begin.begin(), begin.end() - 1);
  for (std::int32_t t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t high = std::max(triples[t][next_corner(i)], triples[t][previous_corner(i)]);
      sides[end[lower(t, i)]++] = {high, linked_edge(t, i)};
    }
  }
  for (std::int32_t v = 0; v < vertex_count; ++v) {
    const auto first = sides.begin() + begin[v], last = sides.begin() + begin[v + 1];
    std::sort(first, last, [](const OpenEdge& a, const OpenEdge& b) {
      return a.high != b.high ? a.high < b.high : a.edge < b.edge;
    });
    for (auto at = first; at != last;) {
      const auto next = std::find_if(at, last, [&](const OpenEdge& side) { return side.high != at->high; });
      if (next - at == 2 && origin(at->edge) != origin(at[1].edge)) join(at->edge, at[1].edge);
      at = next;
    }
  }
}

void TriangleLinks::fix(LinkedEdge edge) {
  triangles[triangle_of(edge)].flags |= 1u << corner_of(edge);
  if (const LinkedEdge other = twin(edge); other != no_linked_edge) {
    triangles[triangle_of(other)].flags |= 1u << corner_of(other);
  }
}

LinkedEdge TriangleLinks::find(std::int32_t a, std::int32_t b) const {
  const std::int32_t start = triangle_at[a];
  const auto runs_to_b = [&](std::int32_t t, int k) { return triangles[t].vertices[next_corner(k)] == b; };
  for (std::int32_t t = start;;) {
    const int k = corner(t, a);
    if (runs_to_b(t, k)) return linked_edge(t, previous_corner(k));
    const LinkedEdge across = triangles[t].links[next_corner(k)];
    if (across == no_linked_edge) break;
    t = triangle_of(across);
    if (t == start) return no_linked_edge;
  }
  for (std::int32_t t = start;;) {  // the fan is open: look at its other part
    const LinkedEdge across = triangles[t].links[previous_corner(corner(t, a))];
    if (across == no_linked_edge) return no_linked_edge;
    t = triangle_of(across);
    const int k = corner(t, a);
    if (runs_to_b(t, k)) return linked_edge(t, previous_corner(k));
  }
}

LinkedEdge TriangleLinks::flip(LinkedEdge edge) {
  const LinkedEdge other = twin(edge);
  const std::int32_t t = triangle_of(edge), u = triangle_of(other);
  const int i = corner_of(edge), j = corner_of(other);
  const LinkedTriangle left = triangles[t], right = triangles[u];
  const std::int32_t a = left.vertices[i], b = left.vertices[next_corner(i)],
                     c = left.vertices[previous_corner(i)];
  const std::int32_t d = right.vertices[j];

  auto& first = triangles[t];
  auto& second = triangles[u];
  first.vertices = {a, b, d};
  second.vertices = {d, c, a};
  first.flags = (left.flags & ~all_edge_bits) | edge_bits(right, next_corner(j)) |
                edge_bits(left, previous_corner(i)) << 2;
  second.flags = (right.flags & ~all_edge_bits) | edge_bits(left, next_corner(i)) |
                 edge_bits(right, previous_corner(j)) << 2;
  join(linked_edge(t, 0), right.links[next_corner(j)]);
  join(linked_edge(t, 2), left.links[previous_corner(i)]);
  join(linked_edge(u, 0), left.links[next_corner(i)]);
  join(linked_edge(u, 2), right.links[previous_corner(j)]);
  join(linked_edge(t, 1), linked_edge(u, 1));
  triangle_at[a] = triangle_at[b] = triangle_at[d] = t;
  triangle_at[c] = u;
  return linked_edge(t, 1);
}

std::int32_t TriangleLinks::divide(LinkedEdge edge) {
  const LinkedEdge other = twin(edge);
  const std::int32_t t = triangle_of(edge), u = triangle_of(other);
  const int i = corner_of(edge), j = corner_of(other);
  const LinkedTriangle left = triangles[t], right = triangles[u];
  const std::int32_t a = left.vertices[i], b = left.vertices[next_corner(i)],
                     c = left.vertices[previous_corner(i)];
  const std::int32_t d = right.vertices[j];
  const auto middle = static_cast<std::int32_t>(triangle_at.size());
  const auto t2 = static_cast<std::int32_t>(triangles.size()), u2 = t2 + 1;
  triangles.resize(triangles.size() + 2);
  triangles[t].vertices = {a, b, middle};
  triangles[t2].vertices = {a, middle, c};
  triangles[u].vertices = {d, c, middle};
  triangles[u2].vertices = {d, middle, b};
  join(linked_edge(t, 0), linked_edge(u2, 0));
  join(linked_edge(t2, 0), linked_edge(u, 0));
  join(linked_edge(t, 1), linked_edge(t2, 2));
  join(linked_edge(u, 1), linked_edge(u2, 2));
  join(linked_edge(t, 2), left.links[previous_corner(i)]);
  join(linked_edge(t2, 1), left.links[next_corner(i)]);
  join(linked_edge(u, 2), right.links[previous_corner(j)]);
  join(linked_edge(u2, 1), right.links[next_corner(j)]);
  triangle_at.push_back(t);
  triangle_at[a] = triangle_at[b] = t;
  triangle_at[c] = triangle_at[d] = u;
  return middle;
}

void TriangleLinks::contract(LinkedEdge edge) {
  const std::int32_t gone = origin(edge), kept = target(edge);
  std::vector<std::int32_t> fan;
  gather_fan(gone, fan);
  const std::int32_t removed[2] = {triangle_of(edge), triangle_of(twin(edge))};
  for (const std::int32_t t : fan) triangles[t].vertices[corner(t, gone)] = kept;
  for (const LinkedEdge e : {edge, twin(edge)}) {
    // The triangle's other two edges become one; that which was the vanished vertex's has a neighbour.
    auto& triangle = triangles[triangle_of(e)];
    LinkedEdge first = triangle.links[next_corner(corner_of(e))],
               second = triangle.links[previous_corner(corner_of(e))];
    if (first == no_linked_edge) std::swap(first, second);
    join(first, second);
    triangle_at[apex(e)] = triangle_of(first);
    triangle_at[kept] = triangle_of(first);
  }
  triangle_at[gone] = -1;
  for (const std::int32_t t : removed)
    triangles[t] = {{-1, -1, -1}, {no_linked_edge, no_linked_edge, no_linked_edge}};
}

bool TriangleLinks::gather_fan(std::int32_t vertex, std::vector<std::int32_t>& fan) const {
  fan.clear();
  const std::int32_t start = triangle_at[vertex];
  for (std::int32_t t = start;;) {
    fan.push_back(t);
    const LinkedEdge across = triangles[t].links[next_corner(corner(t, vertex))];
    if (across == no_linked_edge) break;
    t = triangle_of(across);
    if (t == start) return true;
  }
  const auto counter_clockwise = static_cast<std::ptrdiff_t>(fan.size());
  for (std::int32_t t = start;;) {  // the fan is open: look at its other part
    const LinkedEdge across = triangles[t].links[previous_corner(corner(t, vertex))];
    if (across == no_linked_edge) break;
    t = triangle_of(across);
    fan.push_back(t);
  }
  std::reverse(fan.begin() + counter_clockwise, fan.end());
  std::rotate(fan.begin(), fan.begin() + counter_clockwise, fan.end());
  return false;
}

}  // namespace aeroloom::geometry
