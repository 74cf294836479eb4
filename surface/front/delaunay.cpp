#include "surface/front/delaunay.hpp"

#include <algorithm>
#include <bit>

namespace aeroloom::front {

using geometry::Vec2;

namespace {

/// Of coordinates along a Hilbert curve: both together fill a key.
constexpr int curve_order = 16;
constexpr std::uint32_t largest_coordinate = (1u << curve_order) - 1;

/// Position along a Hilbert curve.
std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = 0;
  for (std::uint32_t side = 1u << (curve_order - 1); side > 0; side >>= 1) {
    const std::uint32_t right = (x & side) ? 1 : 0, up = (y & side) ? 1 : 0;
    key = key << 2 | (3 * right ^ up);
    if (up == 0) {
      if (right == 1) {
        x = largest_coordinate - x;
        y = largest_coordinate - y;
      }
      std::swap(x, y);
    }
  }
  return key;
}

/// A step of the generator splitmix64 (Steele, Lea and Flood, OOPSLA 2014, doi:10.1145/2660193.2660195),
/// whose constants these are.
std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

/// Rounds of doubling size, each along a Hilbert curve: neither long walks nor large cavities (Amenta, Choi
/// and Rote, Proc. Symp. Comput. Geom. 2003, doi:10.1145/777792.777824).
std::vector<std::int32_t> insertion_order(std::span<const Vec2> points, Vec2 low, double extent) {
  struct InsertionKey {
    int round;
    std::uint32_t key;
    std::int32_t vertex;
  };
  std::vector<InsertionKey> places(points.size());
  const double scale = extent > 0 ? static_cast<double>(largest_coordinate) / extent : 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 q = scale * (points[i] - low);
    places[i] = {-std::countr_zero(scramble(i)),
                 hilbert_key(static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y)),
                 static_cast<std::int32_t>(i)};
  }
  std::sort(places.begin(), places.end(), [](const InsertionKey& a, const InsertionKey& b) {
    return a.round != b.round ? a.round < b.round : a.key != b.key ? a.key < b.key : a.vertex < b.vertex;
  });
  std::vector<std::int32_t> order(points.size());
  std::transform(places.begin(), places.end(), order.begin(), [](const InsertionKey& p) { return p.vertex; });
  return order;
}

}  // namespace

Delaunay::Delaunay(std::span<const Vec2> given) : points(given.begin(), given.end()) {
  add_box();
  const Vec2 low = points[given.size()], high = points[given.size() + 2];
  for (const std::int32_t v : insertion_order(given, low, std::max(high.x - low.x, high.y - low.y)))
    insert(v);
}

void Delaunay::add_box() {
  Vec2 low = points.empty() ? Vec2{} : points.front(), high = low;
  for (const Vec2 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double margin = extent > 0 ? extent : 1.0;
  low -= {margin, margin};
  high += {margin, margin};
  const auto v = static_cast<std::int32_t>(points.size());
  points.insert(points.end(), {low, {high.x, low.y}, high, {low.x, high.y}});
  mesh.build({{v, v + 1, v + 2}, {v, v + 2, v + 3}}, v + box_corners);
}

std::int32_t Delaunay::locate(Vec2 point, std::int32_t start) const {
  std::int32_t t = start;
  for (geometry::LinkedEdge entry = geometry::no_linked_edge;;) {
    int exit = -1;
    for (int i = 0; i < 3 && exit < 0; ++i) {
      const geometry::LinkedEdge edge = geometry::linked_edge(t, i);
      if (edge != entry && orientation(points[mesh.origin(edge)], points[mesh.target(edge)], point) < 0)
        exit = i;
    }
    if (exit < 0) return t;
    entry = mesh.triangles[t].links[exit];
    t = geometry::triangle_of(entry);
  }
}

void Delaunay::insert(std::int32_t vertex) {
  const Vec2 point = points[vertex];
  const std::int32_t t = locate(point, _last);
  for (const std::int32_t v : mesh.triangles[t].vertices) {
    if (points[v] == point) {
      _duplicates = true;
      return;
    }
  }
  find_cavity(point, t);
  connect_cavity(vertex);
}

bool Delaunay::find_cavity(Vec2 point, std::int32_t start) {
  _point = point;
  ++_mark;
  _cavity.clear();
  _inside.assign(1, start);
  mesh.triangles[start].mark = _mark;
  _stack = {geometry::linked_edge(start, 2), geometry::linked_edge(start, 1),
            geometry::linked_edge(start, 0)};
  // Depth first and always counter-clockwise, so that the border comes out in order around the point.
  while (!_stack.empty()) {
    const geometry::LinkedEdge edge = _stack.back();
    _stack.pop_back();
    const auto& triangle = mesh.triangles[geometry::triangle_of(edge)];
    const int i = geometry::corner_of(edge);
    const geometry::LinkedEdge outside = triangle.links[i];
    const std::uint32_t flags = triangle.flags >> i & 0b1001u;
    if (outside != geometry::no_linked_edge && !(flags & 1u)) {
      auto& neighbour = mesh.triangles[geometry::triangle_of(outside)];
      const auto& v = neighbour.vertices;
      if (neighbour.mark != _mark && circle_side(points[v[0]], points[v[1]], points[v[2]], point) > 0) {
        neighbour.mark = _mark;
        _inside.push_back(geometry::triangle_of(outside));
        const int j = geometry::corner_of(outside);
        _stack.push_back(geometry::linked_edge(geometry::triangle_of(outside), geometry::previous_corner(j)));
        _stack.push_back(geometry::linked_edge(geometry::triangle_of(outside), geometry::next_corner(j)));
        continue;
      }
    }
    _cavity.push_back({triangle.vertices[geometry::next_corner(i)],
                       triangle.vertices[geometry::previous_corner(i)], outside, flags});
  }
  return _cavity.size() == _inside.size() + 2 && sees_cavity(point);
}

bool Delaunay::sees_cavity(Vec2 point) const {
  return std::all_of(_cavity.begin(), _cavity.end(), [&](const CavityEdge& edge) {
    return orientation(points[edge.origin], points[edge.target], point) > 0;
  });
}

std::int32_t Delaunay::fill_cavity() {
  const auto vertex = static_cast<std::int32_t>(points.size());
  points.push_back(_point);
  mesh.triangle_at.push_back(-1);
  connect_cavity(vertex);
  return vertex;
}

void Delaunay::connect_cavity(std::int32_t vertex) {
  const std::uint32_t user_bits = mesh.triangles[_inside.front()].flags & ~0b111111u;
  _created = _inside;
  while (_created.size() < _cavity.size()) {
    _created.push_back(static_cast<std::int32_t>(mesh.triangles.size()));
    mesh.triangles.emplace_back();
  }
  const std::size_t count = _cavity.size();
  for (std::size_t k = 0; k < count; ++k) {
    const CavityEdge& edge = _cavity[k];
    const std::int32_t t = _created[k];
    auto& triangle = mesh.triangles[t];
    triangle.vertices = {edge.origin, edge.target, vertex};
    triangle.links[0] = geometry::linked_edge(_created[k + 1 < count ? k + 1 : 0], 1);
    triangle.links[1] = geometry::linked_edge(_created[k > 0 ? k - 1 : count - 1], 0);
    triangle.flags = user_bits | edge.flags << 2;
    mesh.join(geometry::linked_edge(t, 2), edge.outside);
    mesh.triangle_at[edge.origin] = t;
  }
  _last = _created.front();
  mesh.triangle_at[vertex] = _last;
}

bool Delaunay::is_flip_wanted(geometry::LinkedEdge edge) const {
  const geometry::LinkedEdge other = mesh.twin(edge);
  if (other == geometry::no_linked_edge || mesh.is_fixed(edge)) return false;
  const auto& v = mesh.triangles[geometry::triangle_of(edge)].vertices;
  return circle_side(points[v[0]], points[v[1]], points[v[2]], points[mesh.apex(other)]) > 0;
}

void Delaunay::restore(std::vector<geometry::LinkedEdge>& stack) {
  while (!stack.empty()) {
    const geometry::LinkedEdge edge = stack.back();
    stack.pop_back();
    if (!is_flip_wanted(edge)) continue;
    const geometry::LinkedEdge diagonal = mesh.flip(edge);
    const std::int32_t t = geometry::triangle_of(diagonal), u = geometry::triangle_of(mesh.twin(diagonal));
    stack.insert(stack.end(), {geometry::linked_edge(t, 0), geometry::linked_edge(t, 2),
                               geometry::linked_edge(u, 0), geometry::linked_edge(u, 2)});
  }
}

bool Delaunay::recover(std::int32_t a, std::int32_t b) {
  geometry::LinkedEdge edge = mesh.find(a, b);
  if (edge == geometry::no_linked_edge) {
    bool blocked = false;
    const geometry::LinkedEdge first = first_crossing(a, b, blocked);
    if (blocked || !collect_crossings(a, b, first)) return false;
    flip_crossings(a, b);
    edge = mesh.find(a, b);
  }
  mesh.fix(edge);
  _stack.clear();
  for (const VertexPair pair : _new_edges) {
    if (const geometry::LinkedEdge e = mesh.find(pair.a, pair.b); e != geometry::no_linked_edge)
      _stack.push_back(e);
  }
  _new_edges.clear();
  restore(_stack);
  return true;
}

/// The edge opposite `a` in the triangle that the segment from a to b enters first. Blocked by a vertex on
/// the segment.
geometry::LinkedEdge Delaunay::first_crossing(std::int32_t a, std::int32_t b, bool& blocked) const {
  const Vec2 from = points[a], to = points[b];
  for (std::int32_t t = mesh.triangle_at[a];;) {
    const int k = mesh.corner(t, a);
    const Vec2 right = points[mesh.triangles[t].vertices[geometry::next_corner(k)]];
    const Vec2 left = points[mesh.triangles[t].vertices[geometry::previous_corner(k)]];
    const int side = orientation(from, right, to);
    if (side == 0 && dot(right - from, to - from) > 0) {
      blocked = true;
      return geometry::no_linked_edge;
    }
    if (side > 0 && orientation(from, to, left) > 0) return geometry::linked_edge(t, k);
    t = geometry::triangle_of(mesh.triangles[t].links[geometry::next_corner(k)]);
  }
}

/// Lists the edges between a and b; false when a fixed edge or a vertex is among what is crossed.
bool Delaunay::collect_crossings(std::int32_t a, std::int32_t b, geometry::LinkedEdge first) {
  _crossings.clear();
  for (geometry::LinkedEdge edge = first;;) {
    if (mesh.is_fixed(edge)) return false;
    _crossings.push_back({mesh.origin(edge), mesh.target(edge)});
    const geometry::LinkedEdge other = mesh.twin(edge);
    const std::int32_t apex = mesh.apex(other);
    if (apex == b) return true;
    const int side = orientation(points[a], points[b], points[apex]);
    if (side == 0) return false;
    const int j = geometry::corner_of(other);
    edge = geometry::linked_edge(geometry::triangle_of(other),
                                 side > 0 ? geometry::next_corner(j) : geometry::previous_corner(j));
  }
}

void Delaunay::flip_crossings(std::int32_t a, std::int32_t b) {
  const auto crosses = [&](std::int32_t x, std::int32_t y) {
    if (x == a || x == b || y == a || y == b) return false;
    return orientation(points[a], points[b], points[x]) * orientation(points[a], points[b], points[y]) < 0;
  };
  _new_edges.clear();
  for (std::size_t k = 0; k < _crossings.size(); ++k) {
    const VertexPair pair = _crossings[k];
    const geometry::LinkedEdge edge = mesh.find(pair.a, pair.b);
    const std::int32_t x = mesh.apex(edge), y = mesh.apex(mesh.twin(edge));
    const bool convex = orientation(points[y], points[x], points[pair.a]) > 0 &&
                        orientation(points[x], points[y], points[pair.b]) > 0;
    if (!convex) {
      _crossings.push_back(pair);
      continue;
    }
    mesh.flip(edge);
    auto& list = crosses(x, y) ? _crossings : _new_edges;
    list.push_back({x, y});
  }
}

}  // namespace aeroloom::front
