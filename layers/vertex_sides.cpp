#include "layers/vertex_sides.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Which side of a triangle.
enum Side : std::int32_t { front = 0, back = 1 };

/// Joins the sides of triangles that face the same space. Side s of triangle t is item 2 t + s.
class SideJoiner {
public:
  SideJoiner(Vec3 vertex, std::span<const SidedTriangle> star)
      : _vertex(vertex), _star(star), _parent(2 * star.size()) {
    std::iota(_parent.begin(), _parent.end(), 0);
  }

  VertexSides join() {
    std::vector<Spoke> spokes;
    for (std::size_t t = 0; t < _star.size(); ++t) {
      const auto number = static_cast<std::int32_t>(t);
      spokes.push_back({_star[t].next, number, true});
      spokes.push_back({_star[t].previous, number, false});
    }
    std::sort(spokes.begin(), spokes.end());
    bool sound = true;
    for (std::size_t i = 0, end = 0; i < spokes.size(); i = end) {
      while (end < spokes.size() && spokes[end].end == spokes[i].end) ++end;
      sound = join_around(std::span(spokes).subspan(i, end - i)) && sound;
    }
    return sound ? numbered() : contradictory();
  }

private:
  /// A triangle at an edge from the vertex; `starts`: the triangle runs along it, seen from the vertex.
  struct Spoke {
    mesh::VertexName end;
    std::int32_t triangle;
    bool starts;
    bool operator<(const Spoke& other) const {
      return std::tuple(end.piece, end.id, triangle) <
             std::tuple(other.end.piece, other.end.id, other.triangle);
    }
  };
  struct Turned {
    double angle;
    std::int32_t triangle;
    bool starts;
  };

  Vec3 end_of(const Spoke& spoke) const {
    const SidedTriangle& t = _star[spoke.triangle];
    return spoke.starts ? t.next_point : t.previous_point;
  }
  Vec3 third_of(const Spoke& spoke) const {
    const SidedTriangle& t = _star[spoke.triangle];
    return spoke.starts ? t.previous_point : t.next_point;
  }
  mesh::RegionId region(std::int32_t triangle, Side side) const {
    return side == front ? _star[triangle].front : _star[triangle].back;
  }
  std::int32_t root(std::int32_t item) {
    while (_parent[item] != item) item = _parent[item] = _parent[_parent[item]];
    return item;
  }

  /// Triangles in the order of their angle about the edge: what lies between two of them is one space.
  bool join_around(std::span<const Spoke> spokes) {
    const Vec3 axis = normalized(end_of(spokes[0]) - _vertex);
    const auto across = [&](Vec3 v) { return v - dot(v, axis) * axis; };
    const Vec3 first = normalized(across(third_of(spokes[0]) - _vertex)), second = cross(axis, first);
    std::vector<Turned> turned;
    for (const Spoke& spoke : spokes) {
      const Vec3 at = third_of(spoke) - _vertex;
      const double angle =
          spoke.triangle == spokes[0].triangle ? 0 : std::atan2(dot(at, second), dot(at, first));
      turned.push_back({angle, spoke.triangle, spoke.starts});
    }
    std::sort(turned.begin(), turned.end(), [](const Turned& a, const Turned& b) {
      return std::tie(a.angle, a.triangle) < std::tie(b.angle, b.triangle);
    });
    bool sound = true;
    for (std::size_t i = 0; i < turned.size(); ++i) {
      // Normals point away from the front: of a triangle that starts along the edge, towards larger angles.
      const Turned &a = turned[i], &b = turned[(i + 1) % turned.size()];
      const Side after = a.starts ? back : front, before = b.starts ? front : back;
      sound = sound && region(a.triangle, after) == region(b.triangle, before);
      const std::int32_t p = root(2 * a.triangle + after), q = root(2 * b.triangle + before);
      _parent[std::max(p, q)] = std::min(p, q);
    }
    return sound;
  }

  VertexSides numbered() {
    std::vector<std::int32_t> order(_star.size()), number(_parent.size(), -1);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
      return std::tie(_star[a].piece, _star[a].cell) < std::tie(_star[b].piece, _star[b].cell);
    });
    std::int32_t next = 0;
    VertexSides sides(_star.size(), {-1, -1});
    for (const std::int32_t t : order) {
      for (const Side side : {front, back}) {
        if (region(t, side) == mesh::no_region) continue;
        std::int32_t& known = number[root(2 * t + side)];
        if (known < 0) known = next++;
        sides[t][side] = known;
      }
    }
    return sides;
  }

  VertexSides contradictory() const {
    VertexSides sides;
    for (const SidedTriangle& t : _star) sides.push_back({0, t.is_inner() ? 0 : -1});
    return sides;
  }

  Vec3 _vertex;
  std::span<const SidedTriangle> _star;
  std::vector<std::int32_t> _parent;
};

}  // namespace

VertexSides find_vertex_sides(Vec3 vertex, std::span<const SidedTriangle> star) {
  return SideJoiner(vertex, star).join();
}

}  // namespace aeroloom::layers
