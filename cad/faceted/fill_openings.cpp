#include "cad/faceted/fill_openings.hpp"

#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A small opening has so many sides at most, less than this part of the area of the surface, and is no
/// longer than this part of the diagonal. Chosen.
constexpr std::size_t most_sides = 12;
constexpr double small_area = 1e-3, small_length = 0.2;
/// More narrow openings are damage. Chosen.
constexpr std::size_t most_narrow = 64;
/// Loops are one opening if no point of the shorter one is farther from the other than this fraction of its
/// own mean width.
constexpr double beside_loop = 0.2;

/// An opening, as a polygon: of one loop, or of two that a seam connects.
struct Opening {
  OpenLoop polygon;
  std::vector<geometry::TriangleCorners> triangles;  ///< of points of the soup
  double length = 0, area = 0;
  bool small = false;
  double width() const { return 2 * area / length; }
};

class OpeningFiller {
public:
  explicit OpeningFiller(FacetSoup& soup) : _soup(soup), _diagonal(box_of_points(soup.points).diagonal()) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      _area += 0.5 * norm(area_vector2(corners_of(soup, t)));
  }

  void fill(Changes& changes) {
    const auto loops = trace();
    if (!loops) return;
    std::vector<Opening> openings;
    for (const OpenLoop& loop : *loops) openings.push_back(span(loop));
    join_loops(openings);
    std::erase_if(openings, [&](const Opening& each) { return !is_filled(each); });
    if (std::ranges::count(openings, false, &Opening::small) > static_cast<std::ptrdiff_t>(most_narrow))
      return;
    drop_crossing(openings);
    add(openings, "a narrow opening", changes);
  }

  void close_named(OpeningRules& rules, Changes& changes) {
    const auto loops = trace();
    if (!loops) return;
    std::vector<Opening> openings;
    for (const OpenLoop& loop : *loops) {
      geometry::Box box;
      for (const std::int32_t p : loop) box.add(_soup.points[p]);
      if (!rules.take(names_beside(_soup, loop), box)) continue;
      Opening& opening = openings.emplace_back(span(loop));
      opening.small = false;
    }
    const std::vector<Opening> all = openings;
    drop_crossing(openings);
    std::erase_if(openings, [](const Opening& each) { return each.triangles.empty(); });
    if (openings.size() < all.size()) {
      const auto lost = std::ranges::find_if(all, [&](const Opening& each) {
        return std::ranges::none_of(openings,
                                    [&](const Opening& kept) { return kept.polygon == each.polygon; });
      });
      throw CadError(
          fmt::format("{}: no triangles close the opening of {} sides at {} without crossing others. Remedy: "
                      "close it in the program that made the file",
                      _soup.file, lost->polygon.size(), place_in_file(_soup.points[lost->polygon.front()])));
    }
    add(openings, "an opening that the case names", changes);
  }

private:
  /// The loops around all openings; none where they branch.
  std::optional<std::vector<OpenLoop>> trace() {
    std::int32_t branch = -1;
    const std::vector<OpenSide> sides = list_open_sides(_soup);
    for (const OpenSide& side : sides) _ways.emplace_back(side.points[0], side.points[1]);
    std::ranges::sort(_ways);
    auto loops = trace_open_loops(_soup, sides, branch);
    if (loops) note_sides(*loops);
    return loops;
  }

  /// The sides that triangles have at points of loops: no triangle of a filling may have one inside.
  void note_sides(const std::vector<OpenLoop>& loops) {
    std::vector<char> is_open(_soup.points.size(), 0);
    for (const OpenLoop& loop : loops)
      for (const std::int32_t p : loop) is_open[p] = 1;
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(3 * _soup.triangles.size()); ++h) {
      const auto [a, b] = std::minmax({side_begin(_soup.triangles, h), side_end(_soup.triangles, h)});
      if (is_open[a] != 0 && is_open[b] != 0) _sides.emplace_back(a, b);
    }
    geometry::sort_unique(_sides);
  }

  Opening span(const OpenLoop& polygon) const {
    Opening opening{polygon, {}, 0, std::numeric_limits<double>::infinity(), false};
    std::vector<Vec3> corners;
    for (const std::int32_t p : polygon) corners.push_back(_soup.points[p]);
    for (std::size_t i = 0; i < corners.size(); ++i)
      opening.length += distance(corners[i], corners[(i + 1) % corners.size()]);
    const auto triangles = span_polygon(corners, [&](std::int32_t i, std::int32_t j) {
      const std::pair<std::int32_t, std::int32_t> side = std::minmax({polygon[i], polygon[j]});
      return side.first != side.second && !std::ranges::binary_search(_sides, side);
    });
    if (triangles.empty()) return opening;
    opening.area = 0;
    const bool along = std::ranges::binary_search(_ways, std::pair(polygon[0], polygon[1]));
    for (const auto& [a, b, c] : triangles) {
      opening.triangles.push_back({polygon[a], polygon[along ? c : b], polygon[along ? b : c]});
      opening.area += 0.5 * norm(cross(corners[b] - corners[a], corners[c] - corners[a]));
    }
    opening.small = polygon.size() <= most_sides && opening.area <= small_area * _area &&
                    opening.length <= small_length * _diagonal;
    return opening;
  }

  bool is_filled(const Opening& opening) const {
    if (opening.triangles.empty()) return false;
    return opening.small || (opening.width() <= tolerances::widest_ruled * _diagonal &&
                             opening.area <= tolerances::widest_filling * _area);
  }

  double away(std::int32_t p, const OpenLoop& loop) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3 a = _soup.points[loop[i]], way = _soup.points[loop[(i + 1) % loop.size()]] - a,
                 off = _soup.points[p] - a;
      const double length2 = dot(way, way),
                   along = length2 > 0 ? std::clamp(dot(off, way) / length2, 0.0, 1.0) : 0;
      least = std::min(least, norm(off - along * way));
    }
    return least;
  }

  bool run_beside(const Opening& a, const Opening& b) const {
    const Opening &shorter = a.length <= b.length ? a : b, &longer = a.length <= b.length ? b : a;
    if (shorter.triangles.empty() || shorter.length < 0.5 * longer.length) return false;
    const double most = beside_loop * shorter.width();
    return std::ranges::all_of(shorter.polygon,
                               [&](std::int32_t p) { return away(p, longer.polygon) <= most; });
  }

  /// Both loops from their nearest points on, with a seam between these. Sides of triangles tell directions.
  Opening join(const Opening& a, const Opening& b) const {
    std::size_t i = 0, j = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < a.polygon.size(); ++k) {
      for (std::size_t l = 0; l < b.polygon.size(); ++l) {
        const double length = distance(_soup.points[a.polygon[k]], _soup.points[b.polygon[l]]);
        if (length < nearest) nearest = length, i = k, j = l;
      }
    }
    Opening best{{}, {}, 0, std::numeric_limits<double>::infinity(), false};
    for (const bool back : {true, false}) {
      OpenLoop polygon;
      for (std::size_t k = 0; k <= a.polygon.size(); ++k)
        polygon.push_back(a.polygon[(i + k) % a.polygon.size()]);
      const std::size_t count = b.polygon.size();
      for (std::size_t l = 0; l <= count; ++l)
        polygon.push_back(b.polygon[(j + (back ? count - l % count : l)) % count]);
      Opening opening = span(polygon);
      if (!opening.triangles.empty() && opening.area < best.area) best = std::move(opening);
    }
    return best;
  }

  /// Quadratic in the loops of more than a few sides, of which more than `most_narrow` are not filled.
  void join_loops(std::vector<Opening>& openings) const {
    std::vector<std::size_t> wide;
    for (std::size_t i = 0; i < openings.size(); ++i)
      if (!openings[i].small) wide.push_back(i);
    if (wide.size() > 2 * most_narrow) return;
    for (std::size_t i = 0; i < wide.size(); ++i) {
      for (std::size_t j = i + 1; j < wide.size(); ++j) {
        Opening &a = openings[wide[i]], &b = openings[wide[j]];
        if (a.polygon.empty() || b.polygon.empty() || !run_beside(a, b)) continue;
        Opening both = join(a, b);
        if (both.triangles.empty()) continue;
        a = std::move(both);
        b = {};
        break;
      }
    }
  }

  FacetSoup filled_with(const std::vector<Opening>& openings) const {
    FacetSoup filled = _soup;
    for (const Opening& opening : openings) {
      filled.triangles.insert(filled.triangles.end(), opening.triangles.begin(), opening.triangles.end());
      filled.group_of.resize(filled.triangles.size(), 0);
    }
    return filled;
  }

  /// Openings whose triangles would meet others stay open.
  void drop_crossing(std::vector<Opening>& openings) const {
    const auto walls = static_cast<std::int32_t>(_soup.triangles.size());
    std::vector<char> crossing(openings.size(), 0);
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < openings.size(); ++i)
      owner.resize(owner.size() + openings[i].triangles.size(), i);
    if (owner.empty()) return;
    for (const FacetContact& contact : list_facet_contacts(filled_with(openings))) {
      for (const std::int32_t t : {contact.first, contact.second})
        if (t >= walls) crossing[owner[t - walls]] = 1;
    }
    std::size_t i = 0;
    std::erase_if(openings, [&](const Opening&) { return crossing[i++] != 0; });
  }

  /// The group with the longest sides around an opening.
  std::int32_t group_beside(const Opening& opening) const {
    std::vector<double> length(_soup.groups.size(), 0);
    for (const geometry::HalfEdge h : open_sides(_soup.triangles)) {
      const std::int32_t a = side_begin(_soup.triangles, h), b = side_end(_soup.triangles, h);
      if (std::ranges::find(opening.polygon, a) != opening.polygon.end() &&
          std::ranges::find(opening.polygon, b) != opening.polygon.end())
        length[_soup.group_of[facet_of(h)]] += distance(_soup.points[a], _soup.points[b]);
    }
    return static_cast<std::int32_t>(std::ranges::max_element(length) - length.begin());
  }

  void add(const std::vector<Opening>& openings, const char* what, Changes& changes) {
    std::size_t holes = 0, sides = 0, triangles = 0;
    double longest = 0;
    Vec3 first;
    std::vector<std::int32_t> groups;
    groups.reserve(openings.size());
    for (const Opening& opening : openings) groups.push_back(opening.small ? group_beside(opening) : -1);
    for (std::size_t i = 0; i < openings.size(); ++i) {
      const Opening& opening = openings[i];
      const Vec3 place = _soup.points[opening.polygon.front()];
      std::int32_t group = groups[i];
      if (opening.small) {
        if (holes++ == 0) first = place;
        sides += opening.polygon.size(), triangles += opening.triangles.size();
        longest = std::max(longest, opening.length);
      } else {
        const std::string name = next_cap_name(_soup);
        FacetSoup::Group cap{name, {}};
        cap.cap = true;
        group = find_group(_soup, cap);
        changes.push_back({fmt::format("{} of {} sides, {:.4g} long and {:.3g} wide in the mean, closed by "
                                       "{} triangles named '{}'",
                                       what, opening.polygon.size(), in_file(opening.length),
                                       in_file(opening.width()), opening.triangles.size(), name),
                           place});
      }
      for (const geometry::TriangleCorners& t : opening.triangles) {
        _soup.triangles.push_back(t);
        _soup.group_of.push_back(group);
      }
    }
    if (holes == 0) return;
    changes.push_back(
        {fmt::format("{} small hole(s) of {} sides in all, {:.3g} around at most, closed by {} triangles",
                     holes, sides, in_file(longest), triangles),
         first});
  }

  FacetSoup& _soup;
  double _diagonal, _area = 0;
  std::vector<std::pair<std::int32_t, std::int32_t>> _sides, _ways;  ///< of triangles; open ones, directed
};

}  // namespace

std::vector<std::string> names_beside(const FacetSoup& soup, std::span<const std::int32_t> points) {
  std::vector<std::int32_t> sorted(points.begin(), points.end());
  geometry::sort_unique(sorted);
  std::vector<std::string> names;
  for (const OpenSide& side : list_open_sides(soup)) {
    const std::string& name = soup.groups[soup.group_of[side.triangle]].name;
    if (std::ranges::all_of(side.points,
                            [&](std::int32_t p) { return std::ranges::binary_search(sorted, p); }))
      names.push_back(name);
  }
  geometry::sort_unique(names);
  std::erase(names, "");
  return names;
}

void close_named_openings(FacetSoup& soup, OpeningRules& rules, Changes& changes) {
  OpeningFiller(soup).close_named(rules, changes);
}

void fill_openings(FacetSoup& soup, Changes& changes) {
  OpeningFiller(soup).fill(changes);
}

}  // namespace aeroloom::cad
