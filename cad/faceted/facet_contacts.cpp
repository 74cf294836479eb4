#include "cad/faceted/facet_contacts.hpp"

#include "aeroloom/geometry/box_tree.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/triangle_contact.hpp"

#include <algorithm>
#include <array>
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

/// Boxes of triangles; long triangles have several, or else the boxes of needles that lie askew overlap all
/// others.
struct FacetPieces {
  explicit FacetPieces(const FacetSoup& soup) {
    std::vector<double> lengths;
    for (const auto& [a, b, c] : soup.triangles)
      lengths.push_back(longest_side({soup.points[a], soup.points[b], soup.points[c]}));
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    const double long_side = lengths.empty() ? 0 : long_over_median * *middle;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      first.push_back(static_cast<std::int32_t>(boxes.size()));
      const auto& [a, b, c] = soup.triangles[t];
      cut({soup.points[a], soup.points[b], soup.points[c]}, long_side, most_cuts);
      owner.resize(boxes.size(), static_cast<std::int32_t>(t));
    }
    first.push_back(static_cast<std::int32_t>(boxes.size()));
  }

  std::vector<geometry::Box> boxes;
  std::vector<std::int32_t> owner;  // of each box
  std::vector<std::int32_t> first;  // box of each triangle

private:
  static constexpr double long_over_median = 2;
  static constexpr int most_cuts = 7;

  static double longest_side(const std::array<Vec3, 3>& t) {
    return std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
  }

  /// Halves the triangle over its longest side until it is short.
  void cut(std::array<Vec3, 3> t, double long_side, int cuts) {
    const double length = longest_side(t);
    if (cuts == 0 || length <= long_side) {
      geometry::Box box;
      for (const Vec3 p : t) box.add(p);
      // Midpoints are rounded: boxes grow by more than that.
      if (cuts < most_cuts) box = box.dilated(1e-14 * (norm(box.low) + norm(box.high)));
      boxes.push_back(box);
      return;
    }
    if (distance(t[1], t[2]) >= length) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
    } else if (distance(t[2], t[0]) >= length) {
      std::rotate(t.begin(), t.begin() + 2, t.end());
    }
    const Vec3 middle = 0.5 * (t[0] + t[1]);
    cut({t[0], middle, t[2]}, long_side, cuts - 1);
    cut({middle, t[1], t[2]}, long_side, cuts - 1);
  }
};

}  // namespace

FacetContacts find_facet_contacts(const FacetSoup& soup, const FacetComponents& components) {
  const FacetPieces pieces(soup);
  const geometry::BoxTree tree(pieces.boxes, facets_per_leaf);
  FacetContacts contacts;
  bool parts = false;
  std::vector<std::int32_t> near;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup.triangles.size()); ++t) {
    near.clear();
    for (std::int32_t i = pieces.first[t]; i < pieces.first[t + 1]; ++i) {
      geometry::for_each_overlap(tree, pieces.boxes, pieces.boxes[i], [&](std::int32_t j) {
        if (pieces.owner[j] > t) near.push_back(pieces.owner[j]);
      });
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    // Of the pairs of this triangle: that of two components first, then the lowest.
    std::int32_t chosen = -1;
    bool apart = false;
    for (const std::int32_t other : near) {
      if (!pair_conflicts(soup, t, other)) continue;
      ++contacts.pairs;
      const bool other_part = components.of[t] != components.of[other];
      if (chosen < 0 || (other_part && !apart)) chosen = other, apart = other_part;
    }
    if (chosen < 0 || (contacts.first >= 0 && (parts || !apart))) continue;
    contacts.first = t, contacts.second = chosen, parts = apart;
  }
  return contacts;
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
