#include "cad/faceted/half_facets.hpp"

#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "cad/faceted/plane_filling.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

void put_points_on_plane(FacetSoup& soup, const FacetPlane& plane, bool beyond, Changes& changes) {
  std::vector<char> put(soup.points.size(), 0);
  for (std::size_t p = 0; p < put.size(); ++p) {
    const double height = plane.height(soup.points[p]);
    put[p] = std::abs(height) <= plane.same || (beyond && height < 0) ? 1 : 0;
  }
  for (const OpenSide& side : list_open_sides(soup)) {
    for (const std::int32_t p : side.points)
      if (std::abs(plane.height(soup.points[p])) <= plane.reach) put[p] = 1;
  }
  const std::vector<char> flat = flat_side_triangles(soup, plane);
  for (std::size_t t = 0; t < flat.size(); ++t) {
    for (const std::int32_t p : soup.triangles[t])
      if (flat[t] != 0) put[p] = 1;
  }
  std::size_t count = 0;
  double most = 0;
  Vec3 where;
  for (std::size_t p = 0; p < put.size(); ++p) {
    if (put[p] == 0) continue;
    const double moved = std::abs(plane.height(soup.points[p]));
    if (moved > plane.same) ++count;
    if (moved > most) most = moved, where = soup.points[p];
    soup.points[p][plane.axis] = plane.position;
  }
  if (count == 0) return;
  changes.push_back(
      {fmt::format("{} points of triangles put on the plane of symmetry {} (those of open and of flat sides "
                   "nearer than {:.3g}, {:.0e} of the diagonal, are)",
                   count, name_of(plane), in_file(plane.reach), tolerances::on_symmetry),
       where, most});
}

/// Keeps what lies on the fluid's side of the plane, and no triangle on it.
class FacetCutter {
public:
  FacetCutter(FacetSoup& soup, const FacetPlane& plane) : _soup(soup), _plane(plane) {
    for (const Vec3 p : soup.points) {
      const double height = plane.height(p);
      _sides.push_back(height > 0 ? 1 : height < 0 ? -1 : 0);
    }
  }

  /// Returns the number of triangles that were cut or dropped beyond the plane.
  std::size_t cut() {
    std::vector<geometry::TriangleCorners> kept;
    std::vector<std::int32_t> groups;
    std::size_t beyond = 0;
    const auto keep = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t group) {
      kept.push_back({a, b, c}), groups.push_back(group);
    };
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      const auto corners = _soup.triangles[t];
      const std::int32_t group = _soup.group_of[t];
      int ahead = 0, behind = 0;
      for (const std::int32_t p : corners) ahead += _sides[p] > 0, behind += _sides[p] < 0;
      beyond += behind > 0;
      if (ahead == 0) continue;
      if (behind == 0) {
        keep(corners[0], corners[1], corners[2], group);
        continue;
      }
      std::vector<std::int32_t> polygon;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = corners[i], b = corners[(i + 1) % 3];
        if (_sides[a] >= 0) polygon.push_back(a);
        if (_sides[a] * _sides[b] < 0) polygon.push_back(crossing(a, b));
      }
      keep(polygon[0], polygon[1], polygon[2], group);
      if (polygon.size() == 4) keep(polygon[0], polygon[2], polygon[3], group);
    }
    _soup.triangles = std::move(kept), _soup.group_of = std::move(groups);
    return beyond;
  }

private:
  /// One point for both triangles of a side.
  std::int32_t crossing(std::int32_t a, std::int32_t b) {
    if (a > b) std::swap(a, b);
    const auto [found, is_new] =
        _crossings.emplace(std::pair(a, b), static_cast<std::int32_t>(_soup.points.size()));
    if (is_new) {
      const Vec3 p = _soup.points[a], q = _soup.points[b];
      const double from = _plane.height(p), to = _plane.height(q);
      Vec3 point = p + from / (from - to) * (q - p);
      point[_plane.axis] = _plane.position;
      _soup.points.push_back(point);
    }
    return found->second;
  }

  FacetSoup& _soup;
  const FacetPlane& _plane;
  std::vector<int> _sides;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> _crossings;
};

/// Fills loops on the plane.
class PlaneCloser {
public:
  PlaneCloser(FacetSoup& soup, const FacetPlane& plane) : _soup(soup), _plane(plane) {
    for (const OpenSide& side : list_open_sides(soup)) {
      if (plane.holds(soup.points[side.points[0]]) && plane.holds(soup.points[side.points[1]]))
        _sides.push_back(side);
    }
  }

  void close(Changes& changes) {
    if (_sides.empty()) {
      throw CadError(
          fmt::format("{}: the triangles only touch the plane of symmetry {}, and have no section there. "
                      "Remedy: FarFieldOptions::symmetry_position inside of the body",
                      _soup.file, name_of(_plane)));
    }
    FacetSoup::Group section{"symmetry_section", {}};
    section.cap = true;
    _group = find_group(_soup, section);
    for (const std::vector<OpenSide>& body : sides_of_bodies())
      if (!fill(body)) refuse(body);
    double length = 0;
    for (const OpenSide& side : _sides)
      length += distance(_soup.points[side.points[0]], _soup.points[side.points[1]]);
    changes.push_back(
        {fmt::format("an open half of triangles, with {} sides on its plane of symmetry {}, {:.4g} long in "
                     "all and around an area of {:.4g}, closed by the plane",
                     _sides.size(), name_of(_plane), in_file(length), in_file(_area, 2))});
  }

private:
  /// The sides of one component on the plane, and the area that they run around.
  struct Outline {
    std::vector<OpenSide> sides;
    double area = 0;
    Box box;  ///< of the component
  };

  /// Twice the area between a side and a point on the plane.
  double area_of(const OpenSide& side) const {
    const Vec3 first = _soup.points[_sides.front().points[0]];
    return cross(_soup.points[side.points[0]] - first, _soup.points[side.points[1]] - first)[_plane.axis];
  }

  /// Whether the sides wind around a point.
  bool encloses(const Outline& outline, Vec3 point) const {
    double angle = 0;
    for (const OpenSide& side : outline.sides) {
      const Vec3 a = _soup.points[side.points[0]] - point, b = _soup.points[side.points[1]] - point;
      angle += std::atan2(cross(a, b)[_plane.axis], dot(a, b));
    }
    return std::abs(angle) > std::numbers::pi;
  }

  /// Largest outline first. Empty where sides run both ways, so that outlines say nothing.
  std::vector<Outline> list_outlines() const {
    const FacetComponents components = find_components(_soup);
    std::map<std::int32_t, Outline> of_components;
    std::map<std::int32_t, int> leaving;
    for (const OpenSide& side : _sides) {
      Outline& outline = of_components[components.of[side.triangle]];
      outline.sides.push_back(side);
      outline.area += area_of(side);
      ++leaving[side.points[0]], --leaving[side.points[1]];
    }
    if (std::ranges::any_of(leaving, [](const auto& point) { return point.second != 0; })) return {};
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      const auto outline = of_components.find(components.of[t]);
      if (outline == of_components.end()) continue;
      for (const Vec3 p : corners_of(_soup, t)) outline->second.box.add(p);
    }
    std::vector<Outline> outlines;
    outlines.reserve(of_components.size());
    for (auto& [component, outline] : of_components) outlines.push_back(std::move(outline));
    std::ranges::stable_sort(outlines, {}, [](const Outline& outline) { return -std::abs(outline.area); });
    return outlines;
  }

  /// Bodies may cross or lie in each other, so each is closed on its own, with the cavities in it: components
  /// within its box whose outlines run the other way inside of its own.
  std::vector<std::vector<OpenSide>> sides_of_bodies() const {
    const std::vector<Outline> outlines = list_outlines();
    if (outlines.empty()) return {_sides};
    std::vector<std::vector<OpenSide>> bodies;
    std::vector<const Outline*> outer;  ///< of each body
    for (const Outline& outline : outlines) {
      std::ptrdiff_t around = -1;  // the smallest one
      for (std::size_t i = 0; i < outer.size(); ++i) {
        if (outer[i]->area * outline.area < 0 && outer[i]->box.contains(outline.box) &&
            encloses(*outer[i], _soup.points[outline.sides.front().points[0]]))
          around = static_cast<std::ptrdiff_t>(i);
      }
      if (around >= 0) {
        bodies[around].insert(bodies[around].end(), outline.sides.begin(), outline.sides.end());
      } else {
        bodies.push_back(outline.sides);
        outer.push_back(&outline);
      }
    }
    return bodies;
  }

  bool fill(const std::vector<OpenSide>& sides) {
    const auto triangles = triangles_on_plane(_soup, sides, _plane);
    if (!triangles) return false;
    for (const geometry::TriangleCorners& corners : *triangles) {
      _soup.triangles.push_back(corners);
      _soup.group_of.push_back(_group);
      _area += 0.5 * norm(area_vector2(corners_of(_soup, _soup.triangles.size() - 1)));
    }
    return true;
  }

  [[noreturn]] void refuse(const std::vector<OpenSide>& sides) const {
    std::int32_t branch = sides.front().points[0];
    trace_open_loops(_soup, sides, branch);
    throw CadError(
        fmt::format("{}: its {} open sides on the plane of symmetry {} form no simple closed loops, near {}. "
                    "Remedy: repair the triangles there in the program that made them",
                    _soup.file, sides.size(), name_of(_plane), place_in_file(_soup.points[branch])));
  }

  FacetSoup& _soup;
  const FacetPlane& _plane;
  std::vector<OpenSide> _sides;
  std::int32_t _group = 0;
  double _area = 0;
};

void drop_unused_points(FacetSoup& soup) {
  std::vector<std::int32_t> same(soup.points.size());
  for (std::size_t p = 0; p < same.size(); ++p) same[p] = static_cast<std::int32_t>(p);
  replace_points(soup, same);
}

}  // namespace

FacetPlane close_half_facets(FacetSoup& soup, const FarFieldOptions& options, OpeningRules& openings,
                             Changes& changes) {
  weld_equal_points(soup);
  drop_flat_triangles(soup, changes);
  if (!open_sides(soup.triangles).empty()) drop_void_triangles(soup, changes);
  join_borders(soup, changes);
  join_borders_beside(soup, changes);
  FacetPlane plane = *find_facet_plane(soup, options);
  changes.push_back({fmt::format("plane of symmetry {}: {}", name_of(plane), plane.reason)});
  const double low = plane.whole.low[plane.axis], high = plane.whole.high[plane.axis];
  const double beyond = plane.positive ? plane.position - low : high - plane.position;
  put_points_on_plane(soup, plane, beyond <= plane.reach, changes);
  refuse_missing_flat_sides(soup, plane);
  const std::size_t cut = FacetCutter(soup, plane).cut();
  if (cut > 0) {
    changes.push_back(
        {fmt::format("{} triangles reached up to {:.4g} beyond the plane of symmetry {}: cut there", cut,
                     in_file(beyond), name_of(plane))});
  }
  if (soup.triangles.empty())
    throw CadError("no body lies on the side of the plane of symmetry that is kept");
  drop_unused_points(soup);
  weld_equal_points(soup);
  drop_flat_triangles(soup, changes);
  if (split_open_sides(soup, 0, NearPoints::in_chain, changes) > 0) drop_void_triangles(soup, changes);
  fill_chains(soup, plane, openings, changes);
  PlaneCloser(soup, plane).close(changes);
  return plane;
}

}  // namespace aeroloom::cad
