#include "cad/faceted/facet_contacts.hpp"

#include "aeroloom/geometry/box_tree.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/triangle_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
  }
  return geometry::meet_wrongly(a, b, common);
}

}  // namespace

FacetContacts find_facet_contacts(const FacetSoup& soup) {
  std::vector<geometry::Box> boxes(soup.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::int32_t corner : soup.triangles[t]) boxes[t].add(soup.points[corner]);
  }
  const geometry::BoxTree tree(boxes, facets_per_leaf);
  FacetContacts contacts;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(boxes.size()); ++t) {
    std::int32_t lowest = -1;
    geometry::for_each_overlap(tree, boxes, boxes[t], [&](std::int32_t other) {
      if (other <= t || !pair_conflicts(soup, t, other)) return;
      ++contacts.pairs;
      if (lowest < 0 || other < lowest) lowest = other;
    });
    if (lowest >= 0 && contacts.first < 0) contacts.first = t, contacts.second = lowest;
  }
  return contacts;
}

FacetComponents find_components(const FacetSoup& soup) {
  geometry::DisjointSets<std::int32_t> sets(soup.points.size());
  for (const auto& [a, b, c] : soup.triangles) sets.unite(a, b), sets.unite(b, c);
  FacetComponents components;
  std::vector<std::int32_t> number(soup.points.size(), -1);
  components.of.reserve(soup.triangles.size());
  for (const auto& triangle : soup.triangles) {
    std::int32_t& own = number[sets.root(triangle[0])];
    if (own < 0) own = components.count++;
    components.of.push_back(own);
  }
  return components;
}

}  // namespace aeroloom::cad
