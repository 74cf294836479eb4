#include "cad/faceted/facet_contacts.hpp"

#include "aeroloom/geometry/box_tree.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/triangle_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

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

}  // namespace

std::vector<FacetContact> list_facet_contacts(const FacetSoup& soup) {
  std::vector<geometry::Box> boxes(soup.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::int32_t corner : soup.triangles[t]) boxes[t].add(soup.points[corner]);
  }
  const geometry::BoxTree tree(boxes, facets_per_leaf);
  std::vector<FacetContact> contacts;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(boxes.size()); ++t) {
    const auto begin = static_cast<std::ptrdiff_t>(contacts.size());
    geometry::for_each_overlap(tree, boxes, boxes[t], [&](std::int32_t other) {
      if (other > t && pair_conflicts(soup, t, other)) contacts.push_back({t, other});
    });
    std::sort(contacts.begin() + begin, contacts.end());
  }
  return contacts;
}

FacetContacts find_facet_contacts(const FacetSoup& soup, const FacetComponents& components) {
  const std::vector<FacetContact> all = list_facet_contacts(soup);
  if (all.empty()) return {};
  const auto apart = std::find_if(all.begin(), all.end(), [&](const FacetContact& pair) {
    return components.of[pair.first] != components.of[pair.second];
  });
  const FacetContact& shown = apart == all.end() ? all.front() : *apart;
  return {all.size(), shown.first, shown.second};
}

std::string shown_place(Vec3 at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", at.x, at.y, at.z);
}

Vec3 middle_of(const FacetSoup& soup, std::int32_t triangle) {
  const auto& [a, b, c] = soup.triangles[triangle];
  return (soup.points[a] + soup.points[b] + soup.points[c]) / 3.0;
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
