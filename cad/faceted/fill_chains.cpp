#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "cad/faceted/half_facets.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A filling is taken before the other one if its area is no more than so many times as large.
constexpr double about_equal = 1.01;

/// A polygon in space and its triangles, corners of which are numbers of the polygon.
struct SpannedPolygon {
  std::vector<Vec3> corners;
  std::vector<geometry::TriangleCorners> triangles;
  double length = 0, area = 0, deviation = 0;
  double width() const { return 2 * area / length; }
};

class PlaneChainFiller {
public:
  PlaneChainFiller(FacetSoup& soup, const FacetPlane& plane, OpeningRules& openings)
      : _soup(soup), _plane(plane), _openings(openings), _diagonal(box_of_points(soup.points).diagonal()) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      _area += 0.5 * norm(area_vector2(corners_of(soup, t)));
    for (const FacetSide& side : sort_sides(soup.triangles)) _taken.emplace_back(side.low, side.high);
  }

  void fill(Changes& changes) {
    for (const std::vector<std::int32_t>& chain : find_chains()) fill_chain(chain, changes);
  }

private:
  bool is_side(std::int32_t a, std::int32_t b) const {
    const std::pair<std::int32_t, std::int32_t> side = std::minmax({a, b});
    return std::ranges::binary_search(_taken, side);
  }

  bool on_plane(std::int32_t p) const { return _plane.holds(_soup.points[p]); }

  /// From the plane back to it, over points beside it, in the direction of the first triangle.
  std::vector<std::vector<std::int32_t>> find_chains() {
    std::vector<std::vector<std::int32_t>> sides_at(_soup.points.size());
    std::vector<OpenSide> sides = list_open_sides(_soup);
    std::erase_if(sides,
                  [&](const OpenSide& side) { return on_plane(side.points[0]) && on_plane(side.points[1]); });
    for (std::size_t s = 0; s < sides.size(); ++s) {
      for (const std::int32_t p : sides[s].points) sides_at[p].push_back(static_cast<std::int32_t>(s));
    }
    std::vector<char> used(sides.size(), 0);
    std::vector<std::vector<std::int32_t>> chains;
    for (std::size_t first = 0; first < sides.size(); ++first) {
      const std::int32_t start = sides[first].points[0];
      if (used[first] != 0 || !on_plane(start)) continue;
      std::vector<std::int32_t>& chain = chains.emplace_back(1, start);
      for (auto s = static_cast<std::int32_t>(first); s >= 0;) {
        used[s] = 1;
        const std::int32_t at = sides[s].points[0] == chain.back() ? sides[s].points[1] : sides[s].points[0];
        // A loop on the way is an opening of its own.
        if (const auto before = std::ranges::find(chain.begin() + 1, chain.end(), at); before != chain.end())
          chain.erase(before, chain.end());
        chain.push_back(at);
        if (on_plane(at)) break;
        const auto next = std::ranges::find_if(sides_at[at], [&](std::int32_t i) { return used[i] == 0; });
        s = next == sides_at[at].end() ? -1 : *next;
      }
      if (!on_plane(chain.back())) {
        throw CadError(fmt::format(
            "{}: a chain of open sides leaves the plane of symmetry {} at {} and ends at {}. Remedy: "
            "repair the triangles there in the program that made them",
            _soup.file, name_of(_plane), place_in_file(_soup.points[chain.front()]),
            place_in_file(_soup.points[chain.back()])));
      }
    }
    return chains;
  }

  /// `corners` begins with the points of the chain.
  SpannedPolygon span(const std::vector<std::int32_t>& chain, std::vector<Vec3> corners) const {
    SpannedPolygon polygon{std::move(corners), {}, 0, 0, 0};
    const auto count = polygon.corners.size();
    for (std::size_t i = 0; i < count; ++i)
      polygon.length += distance(polygon.corners[i], polygon.corners[(i + 1) % count]);
    polygon.triangles = span_polygon(polygon.corners, [&](std::int32_t i, std::int32_t j) {
      return std::max(i, j) >= static_cast<std::int32_t>(chain.size()) || !is_side(chain[i], chain[j]);
    });
    for (const auto& [a, b, c] : polygon.triangles)
      polygon.area +=
          0.5 * norm(cross(polygon.corners[b] - polygon.corners[a], polygon.corners[c] - polygon.corners[a]));
    const Vec3 normal = normalized(polygon_area_vector(polygon.corners));
    for (const Vec3 p : polygon.corners)
      polygon.deviation = std::max(polygon.deviation, std::abs(dot(p - polygon.corners.front(), normal)));
    return polygon;
  }

  /// Between the points of the chain, and the line between its ends.
  SpannedPolygon span_sides(const std::vector<std::int32_t>& chain) const {
    std::vector<Vec3> corners;
    corners.reserve(2 * chain.size());
    for (const std::int32_t p : chain) corners.push_back(_soup.points[p]);
    if (chain.front() == chain.back()) corners.pop_back();
    return span(chain, std::move(corners));
  }

  /// Along the normal of the plane.
  SpannedPolygon drop_down(const std::vector<std::int32_t>& chain) const {
    std::vector<Vec3> corners;
    corners.reserve(2 * chain.size());
    for (const std::int32_t p : chain) corners.push_back(_soup.points[p]);
    const Vec3 first = corners.front();
    for (std::size_t i = chain.size() - 1; i-- > 1;) {
      Vec3 foot = _soup.points[chain[i]];
      foot[_plane.axis] = _plane.position;
      if (distance(foot, corners.back()) > _plane.same && distance(foot, first) > _plane.same)
        corners.push_back(foot);
    }
    if (chain.front() == chain.back() && corners.size() == chain.size()) corners.pop_back();
    return span(chain, std::move(corners));
  }

  bool is_named(const std::vector<std::int32_t>& chain) const {
    Box box;
    for (const std::int32_t p : chain) box.add(_soup.points[p]);
    return _openings.take(names_beside(_soup, chain), box);
  }

  bool is_bearable(const SpannedPolygon& polygon, bool named) const {
    if (polygon.triangles.empty() || named) return named && !polygon.triangles.empty();
    return polygon.area <= tolerances::widest_filling * _area &&
           (polygon.deviation <= tolerances::planar_opening * _diagonal ||
            polygon.width() <= tolerances::widest_ruled * _diagonal);
  }

  void fill_chain(const std::vector<std::int32_t>& chain, Changes& changes) {
    double height = 0, length = 0;
    Vec3 where;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Vec3 p = _soup.points[chain[i]];
      if (_plane.height(p) > height) height = _plane.height(p), where = p;
      if (i > 0) length += distance(p, _soup.points[chain[i - 1]]);
    }
    const SpannedPolygon between = span_sides(chain);
    const bool named = is_named(chain), spanned = is_bearable(between, named) && !_openings.refuse();
    SpannedPolygon down;
    if (named || height <= tolerances::widest_ruled * _diagonal) down = drop_down(chain);
    const bool dropped = is_bearable(down, named) && !_openings.refuse();
    const std::string text = fmt::format(
        "an opening of {} sides, {:.4g} long, that leaves the plane of symmetry {} by up "
        "to {:.4g} at {}",
        chain.size() - 1, in_file(length), name_of(_plane), in_file(height), place_in_file(where));
    if (_openings.refuse())
      throw CadError(fmt::format("{}: {} is not closed: DomainOptions::close refuses", _soup.file, text));
    if (!spanned && !dropped) {
      throw CadError(fmt::format(
          "{}: {} is too wide to be closed: {:.3g} in the mean, and {:.3g} ({} of the diagonal) is the "
          "most. Remedy: close the surface there in the program that made it, or name it in "
          "DomainOptions::close",
          _soup.file, text, in_file(between.width()), in_file(tolerances::widest_ruled * _diagonal),
          tolerances::widest_ruled));
    }
    const bool take_spanned = spanned && (!dropped || between.area <= about_equal * down.area);
    add(take_spanned ? between : down, chain);
    changes.push_back({fmt::format("{}: closed {} by {} triangles of area {:.4g}", text,
                                   take_spanned ? "between its sides" : "down to the plane",
                                   (take_spanned ? between : down).triangles.size(),
                                   in_file((take_spanned ? between : down).area, 2)),
                       where});
  }

  void add(const SpannedPolygon& polygon, const std::vector<std::int32_t>& chain) {
    FacetSoup::Group cap{next_cap_name(_soup), {}};
    cap.cap = true;
    const std::int32_t group = find_group(_soup, cap);
    const bool closed = chain.front() == chain.back();
    std::vector<std::int32_t> numbers(chain.begin(), chain.end() - (closed ? 1 : 0));
    for (std::size_t i = numbers.size(); i < polygon.corners.size(); ++i) {
      numbers.push_back(static_cast<std::int32_t>(_soup.points.size()));
      _soup.points.push_back(polygon.corners[i]);
    }
    const bool along = runs_along(numbers[0], numbers[1]);
    for (const auto& [a, b, c] : polygon.triangles) {
      _soup.triangles.push_back({numbers[a], numbers[along ? c : b], numbers[along ? b : c]});
      _soup.group_of.push_back(group);
    }
  }

  bool runs_along(std::int32_t a, std::int32_t b) const {
    return std::ranges::any_of(open_sides(_soup.triangles), [&](geometry::HalfEdge h) {
      return side_begin(_soup.triangles, h) == a && side_end(_soup.triangles, h) == b;
    });
  }

  FacetSoup& _soup;
  const FacetPlane& _plane;
  OpeningRules& _openings;
  double _diagonal, _area = 0;
  std::vector<std::pair<std::int32_t, std::int32_t>> _taken;  ///< sides of triangles, ascending
};

}  // namespace

void fill_chains(FacetSoup& soup, const FacetPlane& plane, OpeningRules& openings, Changes& changes) {
  PlaneChainFiller(soup, plane, openings).fill(changes);
  weld_equal_points(soup);
}

}  // namespace aeroloom::cad
