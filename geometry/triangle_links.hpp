/// Triangles with links to their neighbours, for the advancing front and for remeshing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::geometry {

/// An edge seen from one of its triangles: 4 * triangle + the corner opposite the edge.
using LinkedEdge = std::int32_t;
inline constexpr LinkedEdge no_linked_edge = -1;

constexpr LinkedEdge linked_edge(std::int32_t triangle, int corner) {
  return 4 * triangle + corner;
}
constexpr std::int32_t triangle_of(LinkedEdge edge) {
  return edge >> 2;
}
constexpr int corner_of(LinkedEdge edge) {
  return edge & 3;
}
constexpr int next_corner(int corner) {
  return corner == 2 ? 0 : corner + 1;
}
constexpr int previous_corner(int corner) {
  return corner == 0 ? 2 : corner - 1;
}

/// A triangle, counter-clockwise. Data of an edge have the index of the opposite corner.
struct LinkedTriangle {
  std::array<std::int32_t, 3> vertices{};
  std::array<LinkedEdge, 3> links{no_linked_edge, no_linked_edge,
                                  no_linked_edge};  ///< the same edge from the other side
  std::uint32_t flags = 0;  ///< bits 0..2: edge is fixed; bits 3..5: edge is tagged; from bit 6: the user's
  std::int32_t mark = 0;    ///< the user's
};

/// Linked triangles, and one triangle of each vertex.
class TriangleLinks {
public:
  std::vector<LinkedTriangle> triangles;
  std::vector<std::int32_t> triangle_at;  ///< per vertex, one triangle that has it; -1 for none

  /// Links triangles given as vertex triples. Edges used by more than two triangles, or twice in one
  /// direction, stay unlinked.
  void build(const std::vector<std::array<std::int32_t, 3>>& triples, std::int32_t vertex_count);

  std::int32_t origin(LinkedEdge edge) const { return corner_vertex(edge, next_corner(corner_of(edge))); }
  std::int32_t target(LinkedEdge edge) const { return corner_vertex(edge, previous_corner(corner_of(edge))); }
  std::int32_t apex(LinkedEdge edge) const { return corner_vertex(edge, corner_of(edge)); }
  LinkedEdge twin(LinkedEdge edge) const { return triangles[triangle_of(edge)].links[corner_of(edge)]; }

  bool is_fixed(LinkedEdge edge) const { return triangles[triangle_of(edge)].flags >> corner_of(edge) & 1u; }
  bool is_tagged(LinkedEdge edge) const {
    return triangles[triangle_of(edge)].flags >> (3 + corner_of(edge)) & 1u;
  }
  void set_tagged(LinkedEdge edge, bool value) {
    const std::uint32_t bit = 8u << corner_of(edge);
    auto& flags = triangles[triangle_of(edge)].flags;
    flags = value ? flags | bit : flags & ~bit;
  }
  /// Fixes the edge on both sides.
  void fix(LinkedEdge edge);
  /// Joins two half edges; `b` may be no_linked_edge.
  void join(LinkedEdge a, LinkedEdge b) {
    triangles[triangle_of(a)].links[corner_of(a)] = b;
    if (b != no_linked_edge) triangles[triangle_of(b)].links[corner_of(b)] = a;
  }
  int corner(std::int32_t triangle, std::int32_t vertex) const {
    const auto& v = triangles[triangle].vertices;
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
  }
  /// The half edge from `a` to `b`, its triangle on the left; no_linked_edge when there is none. Looks around
  /// `a`.
  LinkedEdge find(std::int32_t a, std::int32_t b) const;
  /// Replaces the edge by the other diagonal of its two triangles. Returns the new diagonal, from the apex of
  /// the twin to the apex of the edge. Keeps the flags of the four outer edges and the users' bits of both
  /// triangles.
  LinkedEdge flip(LinkedEdge edge);
  /// Inserts a new vertex, numbered after the last one, on an edge with two triangles, which become four. The
  /// last two triangles are the new ones. Returns the vertex.
  std::int32_t divide(LinkedEdge edge);
  /// Contracts an edge with two triangles: its target replaces its origin, which must have a closed fan. The
  /// two triangles stay in the list with vertices of -1.
  void contract(LinkedEdge edge);
  /// The triangles around a vertex in counter-clockwise order, from border to border if the fan is open.
  /// Returns whether it is closed.
  bool gather_fan(std::int32_t vertex, std::vector<std::int32_t>& fan) const;

private:
  std::int32_t corner_vertex(LinkedEdge edge, int corner) const {
    return triangles[triangle_of(edge)].vertices[corner];
  }
};

}  // namespace aeroloom::geometry
