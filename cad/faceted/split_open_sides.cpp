#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Cosine of the angle between sides that run along each other. Chosen, not measured.
constexpr double along_side = 0.9;

class SideSplitter {
public:
  SideSplitter(FacetSoup& soup, double tolerance, NearPoints rule)
      : _soup(soup),
        _tolerance(tolerance),
        _rule(rule),
        _open(open_sides(soup.triangles)),
        _ends_at(soup.points.size()) {
    for (const geometry::HalfEdge h : _open) {
      const std::int32_t a = side_begin(soup.triangles, h), b = side_end(soup.triangles, h);
      _ends_at[a].push_back(b), _ends_at[b].push_back(a);
      _points.push_back(a), _points.push_back(b);
    }
    geometry::sort_unique(_points);
    for (const std::int32_t p : _points) _boxes.emplace_back().add(soup.points[p]);
    _tree = geometry::BoxTree(_boxes, 8);
  }

  std::size_t split(Changes& changes) {
    std::size_t count = 0;
    const std::size_t last = _open.size();
    for (std::size_t i = 0; i < last;) {
      const std::int32_t t = facet_of(_open[i]);
      std::array<std::vector<std::int32_t>, 3> between;
      for (; i < last && facet_of(_open[i]) == t; ++i) between[_open[i] % 3] = points_on(_open[i]);
      if (between[0].empty() && between[1].empty() && between[2].empty()) continue;
      if (!replace(t, between)) continue;
      if (count++ == 0) _first = _soup.points[_soup.triangles[t][0]];
    }
    if (count > 0) {
      changes.push_back(
          {fmt::format("{} triangles are split where points of others lie on their sides", count), _first,
           _farthest});
    }
    return count;
  }

private:
  /// How far p is from the side ab, and where along it; nothing beyond its ends.
  struct Foot {
    double away, along;
  };
  std::optional<Foot> foot(Vec3 a, Vec3 b, Vec3 p) const {
    const Vec3 way = b - a;
    const double along = dot(p - a, way) / dot(way, way);
    if (!(along > 0 && along < 1)) return {};
    return Foot{distance(p, a + along * way), along};
  }

  /// Open points on an open side, from its begin to its end.
  std::vector<std::int32_t> points_on(geometry::HalfEdge h) const {
    const std::int32_t from = side_begin(_soup.triangles, h), to = side_end(_soup.triangles, h);
    const Vec3 a = _soup.points[from], b = _soup.points[to];
    geometry::Box box;
    box.add(a), box.add(b);
    std::vector<std::pair<double, std::int32_t>> found;
    geometry::for_each_overlap(_tree, _boxes, box.dilated(_tolerance), [&](std::int32_t i) {
      const std::int32_t p = _points[i];
      if (p == from || p == to || p == side_apex(_soup.triangles, h)) return;
      const auto at = foot(a, b, _soup.points[p]);
      if (!at) return;
      const bool exact = on_one_line(a, b, _soup.points[p]);
      const bool near = at->away <= _tolerance && (_rule == NearPoints::in_chain || runs_along(p, a, b));
      if (exact || near) found.emplace_back(at->along, p);
    });
    std::sort(found.begin(), found.end());
    std::vector<std::int32_t> points;
    points.reserve(found.size());
    for (const auto& [along, p] : found) points.push_back(p);
    if (_tolerance > 0 && _rule == NearPoints::in_chain && !is_chain(from, to, points)) points.clear();
    return points;
  }

  /// Whether an open side at p has the direction of the side ab, and p is nearer to it than to its ends.
  bool runs_along(std::int32_t p, Vec3 a, Vec3 b) const {
    const Vec3 at = _soup.points[p], way = normalized(b - a);
    if (std::min(distance(at, a), distance(at, b)) <= _tolerance) return false;
    return std::ranges::any_of(_ends_at[p], [&](std::int32_t q) {
      return std::abs(dot(normalized(_soup.points[q] - at), way)) >= along_side;
    });
  }

  /// Whether other open sides run from point to point.
  bool is_chain(std::int32_t from, std::int32_t to, const std::vector<std::int32_t>& between) const {
    std::int32_t at = from;
    for (std::size_t i = 0; i <= between.size(); ++i) {
      const std::int32_t next = i < between.size() ? between[i] : to;
      if (std::find(_ends_at[at].begin(), _ends_at[at].end(), next) == _ends_at[at].end()) return false;
      at = next;
    }
    return true;
  }

  bool replace(std::int32_t t, const std::array<std::vector<std::int32_t>, 3>& between) {
    const geometry::TriangleCorners corners = _soup.triangles[t];
    const auto& [a, b, c] = corners;
    const auto& points = _soup.points;
    const CoordinatePlane plane(cross(points[b] - points[a], points[c] - points[a]));
    std::vector<std::int32_t> loop, numbers;
    std::vector<geometry::Vec2> places;
    const auto add = [&](std::int32_t p) {
      loop.push_back(static_cast<std::int32_t>(loop.size()));
      numbers.push_back(p);
      places.push_back(plane(points[p]));
    };
    double farthest = 0;
    for (int i = 0; i < 3; ++i) {
      add(corners[i]);
      for (const std::int32_t p : between[i]) {
        add(p);
        const auto at = foot(points[corners[i]], points[corners[(i + 1) % 3]], points[p]);
        if (at && !on_one_line(points[corners[i]], points[corners[(i + 1) % 3]], points[p]))
          farthest = std::max(farthest, at->away);
      }
    }
    const auto ears = cut_ears(std::move(loop), places);
    if (!ears) return false;
    const std::int32_t group = _soup.group_of[t];
    for (std::size_t i = 0; i < ears->size(); ++i) {
      const auto& [x, y, z] = (*ears)[i];
      const geometry::TriangleCorners piece = {numbers[x], numbers[y], numbers[z]};
      if (i == 0) {
        _soup.triangles[t] = piece;
      } else {
        _soup.triangles.push_back(piece);
        _soup.group_of.push_back(group);
      }
    }
    _farthest = std::max(_farthest, farthest);
    return true;
  }

  FacetSoup& _soup;
  double _tolerance;
  NearPoints _rule;
  std::vector<geometry::HalfEdge> _open;            // ascending
  std::vector<std::vector<std::int32_t>> _ends_at;  // of each point: where its open sides lead
  std::vector<std::int32_t> _points;                // of open sides
  std::vector<geometry::Box> _boxes;
  geometry::BoxTree _tree;
  Vec3 _first;
  double _farthest = 0;
};

}  // namespace

std::size_t split_open_sides(FacetSoup& soup, double tolerance, NearPoints rule, Changes& changes) {
  return SideSplitter(soup, tolerance, rule).split(changes);
}

}  // namespace aeroloom::cad
