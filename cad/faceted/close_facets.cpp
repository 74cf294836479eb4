#include "cad/faceted/close_facets.hpp"

#include "cad/faceted/facet_plane.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::cad {
namespace {

/// Points are one only where they are nearer than this fraction of the shortest open side at either.
constexpr double fraction_of_side = 0.25;

/// Pairs of open points that are nearest to each other.
class NearOpenPoints {
public:
  NearOpenPoints(const FacetSoup& soup, double tolerance) : _soup(soup) {
    _room.assign(soup.points.size(), std::numeric_limits<double>::infinity());
    for (const geometry::HalfEdge h : open_sides(soup.triangles)) {
      const std::int32_t a = side_begin(soup.triangles, h), b = side_end(soup.triangles, h);
      const double room = std::min(tolerance, fraction_of_side * distance(soup.points[a], soup.points[b]));
      _room[a] = std::min(_room[a], room), _room[b] = std::min(_room[b], room);
      _points.push_back(a), _points.push_back(b);
    }
    geometry::sort_unique(_points);
    for (const std::int32_t p : _points) _boxes.emplace_back().add(soup.points[p]);
    _tree = geometry::BoxTree(_boxes, 8);
  }

  struct Welds {
    std::vector<std::int32_t> representative;
    std::size_t count = 0;
    double farthest = 0;
    Vec3 first;
  };
  Welds find() const {
    Welds welds;
    welds.representative.resize(_soup.points.size());
    std::iota(welds.representative.begin(), welds.representative.end(), 0);
    for (const std::int32_t p : _points) {
      const std::int32_t q = nearest(p);
      if (q < p || nearest(q) != p) continue;
      welds.representative[q] = p;
      if (welds.count++ == 0) welds.first = _soup.points[p];
      welds.farthest = std::max(welds.farthest, distance(_soup.points[p], _soup.points[q]));
    }
    return welds;
  }

private:
  /// -1 where none is near enough.
  std::int32_t nearest(std::int32_t p) const {
    geometry::Box box;
    box.add(_soup.points[p]);
    std::int32_t best = -1;
    double bound = std::numeric_limits<double>::infinity();
    geometry::for_each_overlap(_tree, _boxes, box.dilated(_room[p]), [&](std::int32_t i) {
      const std::int32_t q = _points[i];
      const double away = distance(_soup.points[p], _soup.points[q]);
      if (q == p || away > std::min(_room[p], _room[q])) return;
      if (away < bound || (away == bound && q < best)) best = q, bound = away;
    });
    return best;
  }

  const FacetSoup& _soup;
  std::vector<double> _room;  // of each point
  std::vector<std::int32_t> _points;
  std::vector<geometry::Box> _boxes;
  geometry::BoxTree _tree;
};

/// Welds open points while that leaves fewer open sides and no more junctions.
void weld_open_points(FacetSoup& soup, double tolerance, Changes& changes) {
  const UnevenSides before = count_uneven_sides(soup.triangles);
  const auto welds = NearOpenPoints(soup, tolerance).find();
  if (welds.count == 0) return;
  FacetSoup welded = soup;
  Changes made;
  made.push_back({fmt::format("{} points are made one with the point beside them", welds.count), welds.first,
                  welds.farthest});
  replace_points(welded, welds.representative);
  drop_void_triangles(welded, made);
  const UnevenSides after = count_uneven_sides(welded.triangles);
  if (after.open >= before.open || after.many > before.many) return;
  soup = std::move(welded);
  changes.insert(changes.end(), made.begin(), made.end());
}

/// Splits open sides at the points of borders beside them, if that leaves fewer open sides.
void split_alongside(FacetSoup& soup, double tolerance, Changes& changes) {
  const UnevenSides before = count_uneven_sides(soup.triangles);
  if (before.open == 0) return;
  FacetSoup split = soup;
  Changes made;
  if (split_open_sides(split, tolerance, NearPoints::alongside, made) == 0) return;
  drop_void_triangles(split, made);
  const UnevenSides after = count_uneven_sides(split.triangles);
  if (after.open >= before.open || after.many > before.many) return;
  soup = std::move(split);
  changes.insert(changes.end(), made.begin(), made.end());
}

/// The mean width of an opening, where its sides form one loop, and the names beside it.
std::string width_text(const FacetSoup& soup, const std::vector<OpenSide>& sides, double length) {
  std::vector<std::string> names;
  for (const OpenSide& side : sides) {
    const std::string& name = soup.groups[soup.group_of[side.triangle]].name;
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  constexpr std::size_t most_named = 4;
  if (names.size() > most_named) names.resize(most_named);
  std::string beside = names.empty() ? "" : fmt::format(" beside '{}'", fmt::join(names, "', '"));
  std::int32_t branch = -1;
  const auto loops = trace_open_loops(soup, sides, branch);
  if (!loops || loops->size() != 1) return beside;
  std::vector<Vec3> corners;
  for (const std::int32_t p : loops->front()) corners.push_back(soup.points[p]);
  return fmt::format(" and {:.3g} wide in the mean{}", in_file(norm(polygon_area_vector(corners)) / length),
                     beside);
}

/// A sentence where the openings look like those of half a model.
std::string half_hint(const std::optional<FacetPlane>& plane) {
  if (!plane) return {};
  return fmt::format(
      ". It seems to be half of a model, open on the plane {}: FarFieldOptions::symmetry '{}' closes it "
      "there",
      name_of(*plane), "xyz"[plane->axis]);
}

bool is_open(const FacetSoup& soup) {
  return !open_sides(soup.triangles).empty();
}

}  // namespace

std::string next_cap_name(const FacetSoup& soup) {
  for (int number = 1;; ++number) {
    std::string name = fmt::format("cap_{}", number);
    if (std::ranges::none_of(soup.groups,
                             [&](const FacetSoup::Group& group) { return group.cap && group.name == name; }))
      return name;
  }
}

void join_borders(FacetSoup& soup, Changes& changes) {
  if (!is_open(soup)) return;
  // What is split may lie on further sides: until nothing is left to split.
  constexpr int rounds = 8;
  for (int i = 0; i < rounds && split_open_sides(soup, 0, NearPoints::in_chain, changes) > 0; ++i)
    drop_void_triangles(soup, changes);
  const double diagonal = box_of_points(soup.points).diagonal();
  for (const double fraction : tolerances::sewing) {
    if (!is_open(soup)) return;
    weld_open_points(soup, fraction * diagonal, changes);
    const double near = std::min(fraction, tolerances::same_place) * diagonal;
    if (split_open_sides(soup, near, NearPoints::in_chain, changes) > 0) drop_void_triangles(soup, changes);
  }
}

void join_borders_beside(FacetSoup& soup, Changes& changes) {
  const double diagonal = box_of_points(soup.points).diagonal();
  for (const double fraction : tolerances::sewing) {
    if (!is_open(soup)) return;
    split_alongside(soup, fraction * diagonal, changes);
    weld_open_points(soup, fraction * diagonal, changes);
  }
}

void close_facets(FacetSoup& soup, OpeningRules& rules, Changes& changes) {
  join_borders(soup, changes);
  if (!is_open(soup) || rules.refuse()) return;
  if (!rules.empty()) {
    join_borders_beside(soup, changes);
    close_named_openings(soup, rules, changes);
    if (!is_open(soup)) return;
  }
  const std::optional<FacetPlane> half = plane_of_open_sides(soup);
  if (cap_facets(soup, changes)) {
    if (half && half->position == 0) changes.push_back({"openings closed by caps" + half_hint(half)});
    return;
  }
  join_borders_beside(soup, changes);
  fill_openings(soup, changes);
  if (is_open(soup)) cap_facets(soup, changes);
}

void refuse_open_sides(const FacetSoup& soup) {
  const std::vector<OpenSide> open = list_open_sides(soup);
  if (open.empty()) return;
  geometry::DisjointSets<std::int32_t> sets(soup.points.size());
  for (const OpenSide& side : open) sets.unite(side.points[0], side.points[1]);
  std::vector<double> length(soup.points.size(), 0);
  std::int32_t longest = -1, loops = 0;
  for (const OpenSide& side : open) {
    const auto [a, b] = side.points;
    const std::int32_t loop = sets.root(a);
    loops += length[loop] == 0;
    length[loop] += distance(soup.points[a], soup.points[b]);
    if (longest < 0 || length[loop] > length[longest]) longest = loop;
  }
  std::vector<OpenSide> own;
  std::ranges::copy_if(open, std::back_inserter(own),
                       [&](const OpenSide& side) { return sets.root(side.points[0]) == longest; });
  throw CadError(fmt::format(
      "{} is not closed: {} sides belong to one triangle only, in {} loops; the longest, of "
      "length {:.6g}{}, passes {}; close the surface there and export it again, or name it "
      "in DomainOptions::close{}",
      soup.file, open.size(), loops, in_file(length[longest]), width_text(soup, own, length[longest]),
      place_in_file(soup.points[longest]), half_hint(plane_of_open_sides(soup))));
}

}  // namespace aeroloom::cad
