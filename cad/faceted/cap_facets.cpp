#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// More openings are damage. Chosen.
constexpr std::size_t most_caps = 32;
/// Openings are closed that have less area than this times the triangles around them; a sheet is no body.
constexpr double widest_cap = 0.5;

struct CapLoop {
  std::vector<std::int32_t> points;
  Vec3 normal, middle;  ///< unit
  double area = 0, length = 0;
  bool used = false;
};

class FacetCaps {
public:
  explicit FacetCaps(FacetSoup& soup) : _soup(soup), _diagonal(box_of_points(soup.points).diagonal()) {}

  bool cap(Changes& changes) {
    if (!trace() || _loops.size() > most_caps) return false;
    for (CapLoop& loop : _loops) {
      if (!measure(loop)) return false;
    }
    const std::size_t before = _soup.triangles.size();
    FacetSoup capped = _soup;
    Changes caps;
    for (CapLoop& loop : _loops) {
      if (!loop.used && !fill_plane_of(loop, capped, caps)) return false;
    }
    if (!open_sides(capped.triangles).empty() || is_sheet(capped, before)) return false;
    _soup = std::move(capped);
    changes.insert(changes.end(), caps.begin(), caps.end());
    return true;
  }

private:
  /// Loops of open sides, two of which meet in every point. False where they form anything else.
  bool trace() {
    std::vector<std::pair<std::int32_t, std::int32_t>> ways;
    for (const geometry::HalfEdge h : open_sides(_soup.triangles)) {
      const std::int32_t a = side_begin(_soup.triangles, h), b = side_end(_soup.triangles, h);
      ways.emplace_back(a, b), ways.emplace_back(b, a);
    }
    std::sort(ways.begin(), ways.end());
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (i % 2 == 0 ? (i + 1 == ways.size() || ways[i + 1].first != ways[i].first)
                     : (i + 1 < ways.size() && ways[i + 1].first == ways[i].first))
        return false;
    }
    std::vector<char> reached(_soup.points.size(), 0);
    for (const auto& way : ways) {
      if (reached[way.first] != 0) continue;
      CapLoop& loop = _loops.emplace_back();
      for (std::int32_t at = way.first, from = -1; reached[at] == 0;) {
        reached[at] = 1;
        loop.points.push_back(at);
        const auto both = std::lower_bound(ways.begin(), ways.end(), std::pair(at, std::int32_t{0}));
        const std::int32_t next = from < 0 || both[0].second != from ? both[0].second : both[1].second;
        from = at, at = next;
      }
    }
    return true;
  }

  bool measure(CapLoop& loop) const {
    std::vector<Vec3> corners;
    for (const std::int32_t p : loop.points) {
      corners.push_back(_soup.points[p]);
      loop.middle += _soup.points[p] / static_cast<double>(loop.points.size());
    }
    const Vec3 area = polygon_area_vector(corners);
    loop.normal = normalized(area);
    loop.area = 0.5 * norm(area);
    for (std::size_t i = 0; i < corners.size(); ++i)
      loop.length += distance(corners[i], corners[(i + 1) % corners.size()]);
    return corners.size() >= 3 && deviation(loop, loop) <= tolerances::planar_opening * _diagonal &&
           loop.area >= tolerances::narrowest_opening * _diagonal * loop.length;
  }

  double deviation(const CapLoop& plane, const CapLoop& loop) const {
    double farthest = 0;
    for (const std::int32_t p : loop.points)
      farthest = std::max(farthest, std::abs(dot(plane.normal, _soup.points[p] - plane.middle)));
    return farthest;
  }

  /// Closes all loops of one plane: every second space from outside inwards.
  bool fill_plane_of(const CapLoop& first, FacetSoup& capped, Changes& caps) {
    const CoordinatePlane plane(first.normal);
    PlaneGraph graph;
    graph.filling = PlaneFilling::alternating;
    std::vector<std::int32_t> numbers;
    double farthest = 0, area = 0;
    for (CapLoop& loop : _loops) {
      const double away = deviation(first, loop);
      if (loop.used || away > tolerances::planar_opening * _diagonal) continue;
      loop.used = true;
      farthest = std::max(farthest, away);
      const auto begin = static_cast<std::int32_t>(numbers.size());
      const auto count = static_cast<std::int32_t>(loop.points.size());
      for (std::int32_t i = 0; i < count; ++i) {
        numbers.push_back(loop.points[i]);
        graph.places.push_back(plane(_soup.points[loop.points[i]]));
        graph.sides.push_back({begin + i, begin + (i + 1) % count});
      }
    }
    const auto triangles = fill_plane_graph(graph);
    if (!triangles) return false;
    const bool turn = runs_as_sides_do(*triangles, numbers);
    const std::string name = next_cap_name(capped);
    FacetSoup::Group cap{name, {}};
    cap.cap = true;
    const std::int32_t group = find_group(capped, cap);
    for (const auto& [a, b, c] : *triangles) {
      const geometry::TriangleCorners t = {numbers[a], numbers[turn ? c : b], numbers[turn ? b : c]};
      capped.triangles.push_back(t);
      area += 0.5 * norm(area_vector2(corners_of(capped, capped.triangles.size() - 1)));
      capped.group_of.push_back(group);
    }
    caps.push_back(
        {fmt::format("a planar opening of area {:.6g} closed by a face named '{}'", in_file(area, 2), name),
         first.middle, farthest});
    return true;
  }

  /// Whether the first triangle of a cap with an open side runs along it in the same direction: the cap then
  /// looks the other way than what it closes.
  bool runs_as_sides_do(const std::vector<geometry::TriangleCorners>& triangles,
                        const std::vector<std::int32_t>& numbers) const {
    std::vector<std::pair<std::int32_t, std::int32_t>> ways;
    for (const geometry::HalfEdge h : open_sides(_soup.triangles))
      ways.emplace_back(side_begin(_soup.triangles, h), side_end(_soup.triangles, h));
    std::sort(ways.begin(), ways.end());
    for (const geometry::TriangleCorners& t : triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::pair way(numbers[t[i]], numbers[t[(i + 1) % 3]]);
        if (std::binary_search(ways.begin(), ways.end(), way)) return true;
        if (std::binary_search(ways.begin(), ways.end(), std::pair(way.second, way.first))) return false;
      }
    }
    return false;
  }

  /// Whether a component would be mostly caps.
  static bool is_sheet(const FacetSoup& capped, std::size_t walls) {
    const FacetComponents components = find_components(capped);
    std::vector<double> wall_area(components.count, 0), cap_area(components.count, 0);
    for (std::size_t t = 0; t < capped.triangles.size(); ++t) {
      (t < walls ? wall_area : cap_area)[components.of[t]] += norm(area_vector2(corners_of(capped, t)));
    }
    for (std::int32_t i = 0; i < components.count; ++i) {
      if (cap_area[i] > widest_cap * wall_area[i]) return true;
    }
    return false;
  }

  FacetSoup& _soup;
  double _diagonal;
  std::vector<CapLoop> _loops;
};

}  // namespace

bool cap_facets(FacetSoup& soup, Changes& changes) {
  return FacetCaps(soup).cap(changes);
}

}  // namespace aeroloom::cad
