#include "cad/faceted/facet_contacts.hpp"

#include "cad/faceted/facet_sides.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/triangle_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::Vec3;

constexpr int facets_per_leaf = 8;  // chosen, not measured

/// Whether the corners of b, but for the common one, surely lie strictly on one side of a's plane: quick, and
/// true for most neighbours.
bool surely_on_one_side(const Vec3 (&a)[3], const Vec3 (&b)[3], int except) {
  const auto sum = [](Vec3 e) { return std::abs(e.x) + std::abs(e.y) + std::abs(e.z); };
  int side = 0;
  for (int i = 0; i < 3; ++i) {
    if (i == except) continue;
    const double volume = geometry::volume6(a[0], a[1], a[2], b[i]);
    const double bound = 1e-14 * sum(a[1] - a[0]) * sum(a[2] - a[0]) * sum(b[i] - a[0]);
    const int here = volume > bound ? 1 : volume < -bound ? -1 : 0;
    if (here == 0 || (side != 0 && here != side)) return false;
    side = here;
  }
  return true;
}

/// Whether a plane through a side of a, upright on it, surely parts the triangles but for the common corner.
bool surely_beside(const Vec3 (&a)[3], const Vec3 (&b)[3], int except) {
  const auto sum = [](Vec3 e) { return std::abs(e.x) + std::abs(e.y) + std::abs(e.z); };
  const Vec3 normal = cross(a[1] - a[0], a[2] - a[0]);
  for (int i = 0; i < 3; ++i) {
    const Vec3 begin = a[i], side = a[(i + 1) % 3] - begin;
    const Vec3 outwards = cross(side, normal);
    bool beside = dot(outwards, a[(i + 2) % 3] - begin) < 0;
    for (int j = 0; j < 3 && beside; ++j) {
      const double bound = 1e-13 * sum(side) * sum(normal) * (sum(b[j] - begin) + sum(side));
      beside = j == except || dot(outwards, b[j] - begin) > bound;
    }
    // The common corner must lie on this side, or else a is on both sides of it.
    if (beside && (except < 0 || b[except] == begin || b[except] == a[(i + 1) % 3])) return true;
  }
  return false;
}

bool pair_conflicts(const FacetSoup& soup, std::int32_t s, std::int32_t t) {
  const auto &first = soup.triangles[s], &second = soup.triangles[t];
  geometry::CommonCorners common;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (first[i] != second[j]) continue;
      common.first[common.count] = i;
      common.second[common.count++] = j;
    }
  }
  const auto& p = soup.points;
  const Vec3 a[3] = {p[first[0]], p[first[1]], p[first[2]]},
             b[3] = {p[second[0]], p[second[1]], p[second[2]]};
  if (common.count < 2) {
    const bool share = common.count == 1;
    if (surely_on_one_side(a, b, share ? common.second[0] : -1)) return false;
    if (surely_on_one_side(b, a, share ? common.first[0] : -1)) return false;
    if (surely_beside(a, b, share ? common.second[0] : -1)) return false;
    if (surely_beside(b, a, share ? common.first[0] : -1)) return false;
  }
  return geometry::meet_wrongly(a, b, common);
}

/// Points around which so many triangles or more lie are searched by directions. Chosen, not measured.
constexpr std::int32_t least_star = 64;

using Frame = std::array<Vec3, 3>;

/// Turned coordinates are off by rounding.
constexpr double rounding = 1e-14;

std::vector<geometry::Box> boxes_of(const FacetSoup& soup, const Frame& frame, double margin) {
  std::vector<geometry::Box> boxes(soup.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::int32_t corner : soup.triangles[t]) {
      const Vec3 p = soup.points[corner];
      boxes[t].add(Vec3{dot(p, frame[0]), dot(p, frame[1]), dot(p, frame[2])});
    }
    if (margin > 0) boxes[t] = boxes[t].dilated(margin);
  }
  return boxes;
}

double half_surface_of(const std::vector<geometry::Box>& boxes) {
  double sum = 0;
  for (const geometry::Box& box : boxes) {
    const Vec3 size = box.size();
    sum += size.x * size.y + size.y * size.z + size.z * size.x;
  }
  return sum;
}

/// Along the longest side of all and its triangle: boxes of needles that run alike are thin there.
Frame frame_of_longest(const FacetSoup& soup) {
  double longest = 0;
  Frame frame{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  for (const auto& t : soup.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = soup.points[t[i]], side = soup.points[t[(i + 1) % 3]] - a;
      const Vec3 normal = cross(side, soup.points[t[(i + 2) % 3]] - a);
      if (!(norm(side) > longest && norm(normal) > 0)) continue;
      longest = norm(side);
      frame[0] = normalized(side), frame[2] = normalized(normal);
      frame[1] = cross(frame[2], frame[0]);
    }
  }
  return frame;
}

/// Pairs of triangles that may meet. Those of a star, the triangles around a point with many, all come near
/// each other there; two of them meet elsewhere only where their directions from the point overlap.
class CandidateSearch {
public:
  explicit CandidateSearch(const FacetSoup& soup) : _soup(soup) {
    constexpr Frame axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double farthest = 0;
    for (const Vec3 p : soup.points)
      farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    _boxes = boxes_of(soup, axes, 0);
    std::vector<geometry::Box> turned = boxes_of(soup, frame_of_longest(soup), rounding * farthest);
    if (half_surface_of(turned) < 0.5 * half_surface_of(_boxes)) _boxes = std::move(turned);
    gather_stars();
    for (Group& group : _groups) group.tree = tree_of(group.members, _boxes, group.boxes);
    std::vector<geometry::Box> all;
    for (const Group& group : _groups) {
      geometry::Box& box = all.emplace_back();
      for (const geometry::Box& own : group.boxes) box.add(own.low), box.add(own.high);
    }
    _group_boxes = std::move(all);
    _of_groups = geometry::BoxTree(_group_boxes, facets_per_leaf);
  }

  template <class Visit>
  void for_each(std::int32_t t, const Visit& visit) const {
    const std::int32_t own = _group_of[t];
    geometry::for_each_overlap(_of_groups, _group_boxes, _boxes[t], [&](std::int32_t g) {
      const Group& group = _groups[g];
      if (g == own && g > 0) {
        geometry::for_each_overlap(group.by_direction, group.directions, group.directions[_place[t]],
                                   [&](std::int32_t i) { visit(group.members[i]); });
      } else {
        geometry::for_each_overlap(group.tree, group.boxes, _boxes[t],
                                   [&](std::int32_t i) { visit(group.members[i]); });
      }
    });
  }

private:
  /// A star, or all triangles in none: the first.
  struct Group {
    std::vector<std::int32_t> members;
    std::vector<geometry::Box> boxes, directions;
    geometry::BoxTree tree, by_direction;
  };

  static geometry::BoxTree tree_of(const std::vector<std::int32_t>& members,
                                   const std::vector<geometry::Box>& all, std::vector<geometry::Box>& own) {
    for (const std::int32_t t : members) own.push_back(all[t]);
    return {own, facets_per_leaf};
  }

  void gather_stars() {
    std::vector<std::int32_t> degree(_soup.points.size(), 0), star(_soup.points.size(), 0);
    for (const auto& t : _soup.triangles) {
      for (const std::int32_t p : t) ++degree[p];
    }
    _groups.resize(1);
    _group_of.resize(_soup.triangles.size(), 0), _place.resize(_soup.triangles.size());
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      const auto& corners = _soup.triangles[t];
      const std::int32_t p =
          *std::ranges::max_element(corners, [&](auto a, auto b) { return degree[a] < degree[b]; });
      if (degree[p] >= least_star && star[p] == 0) {
        star[p] = static_cast<std::int32_t>(_groups.size());
        _groups.emplace_back();
      }
      Group& group = _groups[star[p]];
      _group_of[t] = star[p];
      _place[t] = static_cast<std::int32_t>(group.members.size());
      group.members.push_back(static_cast<std::int32_t>(t));
      if (star[p] > 0) group.directions.push_back(directions_of(corners, p));
    }
    for (Group& group : _groups) group.by_direction = geometry::BoxTree(group.directions, facets_per_leaf);
  }

  /// The box of the arc on the unit sphere that the triangle is seen as from its corner.
  geometry::Box directions_of(const geometry::TriangleCorners& corners, std::int32_t from) const {
    geometry::Box box;
    Vec3 sum;
    for (const std::int32_t p : corners) {
      if (p == from) continue;
      const Vec3 way = normalized(_soup.points[p] - _soup.points[from]);
      box.add(way);
      sum += way;
    }
    const double bulge = 1 - 0.5 * norm(sum);  // of the arc over its chord
    return box.dilated(bulge + 1e-12);
  }

  const FacetSoup& _soup;
  std::vector<geometry::Box> _boxes, _group_boxes;
  std::vector<Group> _groups;
  std::vector<std::int32_t> _group_of, _place;  // of each triangle, and its place among the members
  geometry::BoxTree _of_groups;
};

}  // namespace

std::vector<FacetContact> list_facet_contacts(const FacetSoup& soup) {
  const CandidateSearch search(soup);
  std::vector<FacetContact> contacts;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup.triangles.size()); ++t) {
    const auto begin = static_cast<std::ptrdiff_t>(contacts.size());
    search.for_each(t, [&](std::int32_t other) {
      if (other > t && pair_conflicts(soup, t, other)) contacts.push_back({t, other});
    });
    std::sort(contacts.begin() + begin, contacts.end());
  }
  return contacts;
}

std::string component_name(const FacetSoup& soup, const FacetComponents& components, std::int32_t triangle) {
  const FacetSoup::Group& group = soup.groups[soup.group_of[triangle]];
  const std::string& name = group.part.empty() ? group.name : group.part;
  return fmt::format("component {}{}", components.of[triangle],
                     name.empty() ? "" : fmt::format(" ('{}')", name));
}

FacetComponents find_components(const FacetSoup& soup) {
  geometry::DisjointSets<std::int32_t> sets(soup.triangles.size());
  for_each_side(sort_sides(soup.triangles), [&](std::span<const FacetSide> passes) {
    for (const FacetSide& pass : passes)
      sets.unite(facet_of(passes.front().half_edge), facet_of(pass.half_edge));
  });
  FacetComponents components;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(sets.size()); ++t) {
    const std::int32_t root = sets.root(t);
    components.of.push_back(root == t ? components.count++ : components.of[root]);
  }
  return components;
}

}  // namespace aeroloom::cad
