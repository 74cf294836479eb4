#include "layers/ridge_paths.hpp"

#include "geometry/half_edges.hpp"
#include "geometry/sort_unique.hpp"
#include "layers/cone.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <tuple>

namespace aeroloom::layers {
namespace {

using geometry::HalfEdge;
using geometry::Vec3;
using mesh::VertexName;

// The bounds of this file are chosen, not measured.

/// Rings of triangles around an end in which its path is looked for, and ends of a case for which it is.
constexpr std::int32_t rings = 20;
constexpr std::size_t most_ends = 200;
constexpr double degree = std::numbers::pi / 180;
/// Bends, on the wall laid flat: of a path, where it leaves its ridge, and least angle between it and the
/// edges of a ridge that it meets.
constexpr double most_bend = 70 * degree, most_first_bend = 110 * degree, least_meeting = 40 * degree;
/// A bend of 60 degrees counts as an edge more, an edge beside a ridge as two, and a place where a ridge
/// passes as so many.
constexpr double joint_cost = 3;
/// Edges over which the angle between the outer columns falls from that of the ridge.
constexpr double fading = 2;
constexpr double least_seen = 0.3;

/// What a path may do at a vertex.
enum class PathPlace : std::uint32_t {
  wall,     ///< go on
  passing,  ///< end: a ridge passes
  rim,      ///< end: on a plane that layers end on
  open,     ///< start or end: a ridge ends
  forbidden
};

/// A triangle near ends.
struct TriangleAtEnd {
  std::array<VertexName, 3> names;
  std::array<Vec3, 3> points;
  std::int64_t piece, cell;
  std::array<PathPlace, 3> places;
  std::uint32_t ridges;  ///< bit i: the edge from corner i is of a ridge
  auto order() const { return std::tie(piece, cell); }
};

/// The end of a ridge.
struct OpenEnd {
  VertexName vertex, along;  ///< and the other vertex of its edge
};

class NearWall {
public:
  NearWall(const LocalWall& wall, const VertexStars& stars)
      : _wall(wall), _stars(stars), _names(wall.vertex_names()) {}

  std::vector<OpenEnd> ends() const {
    std::vector<OpenEnd> mine;
    for (const auto& [v, along] : _stars.open_ends) {
      if (_wall.owned[v] != 0) mine.push_back({_names[v], along});
    }
    std::vector<OpenEnd> all = _wall.mesh.communicator.all_gather_items(std::span<const OpenEnd>(mine));
    std::sort(all.begin(), all.end(),
              [](const OpenEnd& a, const OpenEnd& b) { return precedes(a.vertex, b.vertex); });
    return all;
  }

  /// The layered triangles within the rings, by piece and number.
  std::vector<TriangleAtEnd> triangles() const {
    const std::vector<std::int32_t> ring = mark_rings();
    std::vector<TriangleAtEnd> mine;
    for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
      const auto& corners = _wall.triangles[t];
      const bool is_near =
          std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) { return ring[v] > 0; });
      if (_wall.roles[t] != WallRole::layered || !is_near) continue;
      const TrianglePlace place = _wall.place_of(t);
      TriangleAtEnd& near = mine.emplace_back();
      near.piece = place.piece, near.cell = place.cell, near.ridges = 0;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t v = corners[i];
        near.names[i] = _names[v];
        near.points[i] = _wall.points[v];
        near.places[i] = place_at(v);
        if (is_ridge(v, corners[(i + 1) % 3])) near.ridges |= 1U << static_cast<unsigned>(i);
      }
    }
    std::vector<TriangleAtEnd> all =
        _wall.mesh.communicator.all_gather_items(std::span<const TriangleAtEnd>(mine));
    std::sort(all.begin(), all.end(),
              [](const TriangleAtEnd& a, const TriangleAtEnd& b) { return a.order() < b.order(); });
    return all;
  }

private:
  std::vector<std::int32_t> mark_rings() const {
    std::vector<std::int32_t> ring(_wall.points.size(), 0);
    for (const auto& [v, along] : _stars.open_ends) ring[v] = rings + 1;
    for (std::int32_t round = 0; round < rings; ++round) {
      std::vector<std::int32_t> next = ring;
      for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
        if (_wall.roles[t] != WallRole::layered) continue;
        const auto& [a, b, c] = _wall.triangles[t];
        const std::int32_t most = std::max({ring[a], ring[b], ring[c]}) - 1;
        for (const std::int32_t v : {a, b, c}) next[v] = std::max(next[v], most);
      }
      ring = std::move(next);
      _wall.combine(ring, [](std::int32_t a, std::int32_t b) { return std::max(a, b); });
    }
    return ring;
  }

  PathPlace place_at(std::int32_t v) const {
    const bool can_name = _names[v].piece >= 0 || mesh::can_name_columns(_names[v].id);
    if (_stars.kinds[v] != StarKind::plain || !can_name || _stars.ends.at(v) != nullptr)
      return PathPlace::forbidden;
    const bool is_open = std::any_of(_stars.open_ends.begin(), _stars.open_ends.end(),
                                     [&](const auto& end) { return end.first == v; });
    if (is_open) return PathPlace::open;
    const std::size_t planes = _stars.planes_at(v).size();
    if (const Ridge* ridge = _stars.ridge_at(v))
      return ridge->is_corner() || planes > 0 ? PathPlace::forbidden : PathPlace::passing;
    if (planes > 0) return planes == 1 ? PathPlace::rim : PathPlace::forbidden;
    return smallest_cone(_stars.normals_at(v)).visibility < least_seen ? PathPlace::forbidden
                                                                       : PathPlace::wall;
  }

  bool is_ridge(std::int32_t from, std::int32_t to) const {
    const Ridge* ridge = _stars.ridge_at(from);
    return ridge != nullptr && std::any_of(ridge->edges.begin(), ridge->edges.end(),
                                           [&](const Ridge::Edge& edge) { return edge.end == _names[to]; });
  }

  const LocalWall& _wall;
  const VertexStars& _stars;
  std::vector<VertexName> _names;
};

/// The triangles as a graph of half-edges: a path is a chain of them.
class PathSearch {
public:
  explicit PathSearch(const std::vector<TriangleAtEnd>& triangles) : _triangles(triangles) {
    for (const TriangleAtEnd& t : triangles) _names.insert(_names.end(), t.names.begin(), t.names.end());
    geometry::sort_unique(_names, precedes);
    _places.assign(_names.size(), PathPlace::wall);
    _points.resize(_names.size());
    for (const TriangleAtEnd& t : triangles) {
      auto& corners = _corners.emplace_back();
      for (int i = 0; i < 3; ++i) {
        corners[i] = find(t.names[i]);
        _places[corners[i]] = t.places[i];
        _points[corners[i]] = t.points[i];
      }
    }
    _twins = geometry::match_half_edges(_corners);
    go_around_vertices();
    mark_beside_ridges();
  }

  /// The vertices from an end on, and the angle between both sides there; empty: there is no path.
  struct Path {
    std::vector<std::int32_t> vertices;
    double turn = 0;
  };
  Path find_path(const OpenEnd& end) {
    const std::int32_t start = find(end.vertex);
    if (start < 0 || _places[start] != PathPlace::open) return {};
    const HalfEdge ridge = half_edge(start, find(end.along));
    if (ridge < 0 || !is_closed(start)) return {};
    const HalfEdge last = search(start, ridge);
    if (last < 0) return {};
    Path path;
    HalfEdge first = last;
    path.vertices.push_back(target(last));
    for (HalfEdge h = last; h >= 0; h = _before[h]) path.vertices.push_back(origin(h)), first = h;
    std::reverse(path.vertices.begin(), path.vertices.end());
    path.turn = turn_between(ridge, first);
    std::vector<std::int32_t> each = path.vertices;
    geometry::sort_unique(each);
    if (each.size() < path.vertices.size()) return {};
    for (const std::int32_t v : path.vertices) _places[v] = PathPlace::forbidden;
    return path;
  }
  bool is_taken(const OpenEnd& end) const {
    const std::int32_t v = find(end.vertex);
    return v >= 0 && _places[v] == PathPlace::forbidden;
  }
  const VertexName& name(std::int32_t v) const { return _names[v]; }

private:
  std::int32_t find(const VertexName& name) const {
    const auto at = std::lower_bound(_names.begin(), _names.end(), name, precedes);
    return at != _names.end() && *at == name ? static_cast<std::int32_t>(at - _names.begin()) : -1;
  }
  std::int32_t origin(HalfEdge h) const { return _corners[h / 3][h % 3]; }
  std::int32_t target(HalfEdge h) const { return _corners[h / 3][geometry::next_half_edge(h) % 3]; }
  double length(HalfEdge h) const { return distance(_points[origin(h)], _points[target(h)]); }
  HalfEdge half_edge(std::int32_t from, std::int32_t to) const {
    for (const HalfEdge h : _out[from]) {
      if (target(h) == to) return h;
    }
    return -1;
  }
  bool is_closed(std::int32_t v) const { return _around[v] > 0; }

  /// The half-edges from each vertex counter-clockwise, and the angles at which they leave, scaled to 360
  /// degrees in all where the triangles close around it.
  void go_around_vertices() {
    _out.resize(_names.size()), _around.assign(_names.size(), 0), _angles.assign(_twins.size(), 0);
    std::vector<HalfEdge> first(_names.size(), -1);
    for (HalfEdge h = 0; h < static_cast<HalfEdge>(_twins.size()); ++h) {
      HalfEdge& known = first[origin(h)];
      if (known < 0 || _twins[h] < 0) known = h;  // an open star starts at its border
    }
    for (std::size_t v = 0; v < first.size(); ++v) {
      double angle = 0;
      HalfEdge h = first[v];
      do {
        _out[v].push_back(h);
        _angles[h] = angle;
        const HalfEdge back = geometry::previous_half_edge(h);
        const Vec3 a = _points[target(h)] - _points[v], b = _points[origin(back)] - _points[v];
        angle += std::acos(std::clamp(dot(normalized(a), normalized(b)), -1.0, 1.0));
        h = _twins[back];
      } while (h >= 0 && h != first[v]);
      if (h < 0) continue;
      _around[v] = angle;
      for (const HalfEdge each : _out[v]) _angles[each] *= 2 * std::numbers::pi / angle;
    }
  }

  /// Triangles at ridges that their vertices are not of.
  void mark_beside_ridges() {
    _beside.assign(_names.size(), 0);
    for (std::size_t t = 0; t < _corners.size(); ++t) {
      const bool is_at_ridge = std::any_of(_corners[t].begin(), _corners[t].end(),
                                           [&](std::int32_t v) { return _places[v] == PathPlace::passing; });
      if (!is_at_ridge) continue;
      for (const std::int32_t v : _corners[t]) _beside[v] = 1;
    }
  }

  /// Between two half-edges that leave a vertex, of 0 to 180 degrees.
  double angle_between(HalfEdge a, HalfEdge b) const {
    const double angle = std::abs(_angles[a] - _angles[b]);
    return std::min(angle, 2 * std::numbers::pi - angle);
  }
  /// How far a path that comes from `back` is off going straight on along h.
  double bend(HalfEdge back, HalfEdge h) const { return std::numbers::pi - angle_between(back, h); }

  /// Between the mean normals on both sides of two half-edges that leave a vertex.
  double turn_between(HalfEdge a, HalfEdge b) const {
    Vec3 sums[2];
    const std::vector<HalfEdge>& out = _out[origin(a)];
    const auto at = [&](HalfEdge h) { return std::find(out.begin(), out.end(), h) - out.begin(); };
    const auto from = std::min(at(a), at(b)), to = std::max(at(a), at(b));
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(out.size()); ++i) {
      const auto& [u, v, w] = _corners[out[static_cast<std::size_t>(i)] / 3];
      sums[i >= from && i < to ? 1 : 0] +=
          normalized(cross(_points[v] - _points[u], _points[w] - _points[u]));
    }
    return std::acos(std::clamp(dot(normalized(sums[0]), normalized(sums[1])), -1.0, 1.0));
  }

  /// Whether the wall turns to the fluid over an edge: sectors cannot lie over it.
  bool is_concave(HalfEdge h) const {
    const double most = std::cos(15 * degree);
    const auto normal = [&](HalfEdge of) {
      const auto& [u, v, w] = _corners[of / 3];
      return normalized(cross(_points[v] - _points[u], _points[w] - _points[u]));
    };
    if (_twins[h] < 0) return true;
    const Vec3 left = normal(h), right = normal(_twins[h]);
    return dot(left, right) < most && dot(cross(right, left), _points[target(h)] - _points[origin(h)]) > 0;
  }

  double cost(HalfEdge h, double bend) const {
    const double edges = 1 + std::pow(bend / (60 * degree), 2) + (_beside[target(h)] != 0 ? 1 : 0);
    return edges * length(h);
  }

  /// The cost at a place where a path may end; infinite where it may not.
  double cost_of_end(HalfEdge h) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::int32_t v = target(h);
    if (_places[v] == PathPlace::rim) return 0;
    const HalfEdge back = _twins[h];
    if (back < 0 || !is_closed(v)) return infinity;
    for (const HalfEdge out : _out[v]) {
      const bool is_ridge = (_triangles[out / 3].ridges >> static_cast<unsigned>(out % 3) & 1U) != 0;
      if (is_ridge && angle_between(back, out) < least_meeting) return infinity;
    }
    return _places[v] == PathPlace::open ? 0 : joint_cost * length(h);
  }

  /// The last half-edge of the cheapest path (Dijkstra); _before leads back.
  HalfEdge search(std::int32_t start, HalfEdge ridge) {
    using Entry = std::tuple<double, HalfEdge, bool>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> costs(_twins.size(), std::numeric_limits<double>::infinity());
    _before.assign(_twins.size(), -1);
    const auto reach = [&](HalfEdge h, HalfEdge from, double paid) {
      const PathPlace place = _places[target(h)];
      if (place == PathPlace::forbidden || target(h) == start || paid >= costs[h]) return;
      costs[h] = paid;
      _before[h] = from;
      queue.emplace(place == PathPlace::wall ? paid : paid + cost_of_end(h), h, place != PathPlace::wall);
    };
    for (const HalfEdge h : _out[start]) {
      if (h != ridge && !is_concave(h) && bend(ridge, h) <= most_first_bend)
        reach(h, -1, cost(h, 0.5 * bend(ridge, h)));
    }
    while (!queue.empty()) {
      const auto [paid, h, is_end] = queue.top();
      queue.pop();
      if (paid == std::numeric_limits<double>::infinity()) break;
      if (is_end) return h;
      const HalfEdge back = _twins[h];
      if (paid > costs[h] || back < 0 || !is_closed(target(h))) continue;
      for (const HalfEdge out : _out[target(h)]) {
        const double bent = bend(back, out);
        if (out != back && !is_concave(out) && bent <= most_bend) reach(out, h, paid + cost(out, bent));
      }
    }
    return -1;
  }

  const std::vector<TriangleAtEnd>& _triangles;
  std::vector<VertexName> _names;
  std::vector<PathPlace> _places;
  std::vector<Vec3> _points;
  std::vector<geometry::TriangleCorners> _corners;
  std::vector<HalfEdge> _twins, _before;
  std::vector<std::vector<HalfEdge>> _out;  // by vertex
  std::vector<double> _angles;              // by half-edge
  std::vector<double> _around;              // by vertex: sum of its angles; 0 where its star is open
  std::vector<std::uint8_t> _beside;
};

/// Both directions of the edges of a path.
void append_edges(const PathSearch& search, const PathSearch::Path& path, bool ends_open, PathEdges& edges) {
  const std::size_t last = path.vertices.size() - 1;
  const auto turn_at = [&](std::size_t i) {
    const double away = static_cast<double>(ends_open ? std::min(i, last - i) : i);
    return std::max(0.01, path.turn * (1 - away / fading));
  };
  for (std::size_t i = 0; i < last; ++i) {
    const VertexName a = search.name(path.vertices[i]), b = search.name(path.vertices[i + 1]);
    edges.push_back({a, b, turn_at(i)});
    edges.push_back({b, a, turn_at(i + 1)});
  }
}

}  // namespace

PathEdges find_ridge_paths(const LocalWall& wall, const VertexStars& stars) {
  const auto& communicator = wall.mesh.communicator;
  const auto open = static_cast<std::int64_t>(stars.open_ends.size());
  if (communicator.sum(open) == 0 || communicator.sum(stars.lost_ridges - open) > 0) return {};
  const NearWall near(wall, stars);
  const std::vector<OpenEnd> ends = near.ends();
  if (ends.size() > most_ends) return {};
  const std::vector<TriangleAtEnd> triangles = near.triangles();
  PathSearch search(triangles);
  PathEdges edges;
  for (const OpenEnd& end : ends) {
    if (search.is_taken(end)) continue;
    const PathSearch::Path path = search.find_path(end);
    if (path.vertices.empty()) return {};
    const VertexName last = search.name(path.vertices.back());
    const bool ends_open =
        std::any_of(ends.begin(), ends.end(), [&](const OpenEnd& other) { return other.vertex == last; });
    append_edges(search, path, ends_open, edges);
  }
  std::sort(edges.begin(), edges.end(), [](const PathEdge& a, const PathEdge& b) {
    return a.from == b.from ? precedes(a.to, b.to) : precedes(a.from, b.from);
  });
  return edges;
}

}  // namespace aeroloom::layers
