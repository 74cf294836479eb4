#include "volume/filling/surface_check.hpp"

#include "geometry/place_text.hpp"
#include "geometry/predicates.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::LocalIndex;

namespace {

SurfaceDefect made(const char* what, std::vector<std::int32_t> triangles) {
  geometry::sort_unique(triangles);
  return triangles.empty() ? SurfaceDefect{} : SurfaceDefect{what, std::move(triangles)};
}

bool has_no_area(Vec3 a, Vec3 b, Vec3 c) {
  return geometry::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
         geometry::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         geometry::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

SurfaceDefect find_wild_indices(const TriangleSoup& surface) {
  std::vector<std::int32_t> wild;
  const auto count = static_cast<LocalIndex>(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= count) wild.push_back(static_cast<std::int32_t>(t));
  }
  return made("triangles refer to points that do not exist", wild);
}

SurfaceDefect find_flat_triangles(const TriangleSoup& surface) {
  std::vector<std::int32_t> flat;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (has_no_area(surface.points[a], surface.points[b], surface.points[c]))
      flat.push_back(static_cast<std::int32_t>(t));
  }
  return made("triangles have no area", flat);
}

/// The triangles that have a marked point.
std::vector<std::int32_t> triangles_at(const TriangleSoup& surface, const std::vector<std::uint8_t>& marked) {
  std::vector<std::int32_t> found;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (marked[a] || marked[b] || marked[c]) found.push_back(static_cast<std::int32_t>(t));
  }
  return found;
}

SurfaceDefect find_infinite_points(const TriangleSoup& surface) {
  std::vector<std::uint8_t> infinite(surface.points.size(), 0);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Vec3 p = surface.points[v];
    infinite[v] = !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  return made("coordinates are not finite", triangles_at(surface, infinite));
}

SurfaceDefect find_coincident_points(const TriangleSoup& surface) {
  const auto points = surface.points;
  std::vector<LocalIndex> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](LocalIndex i, LocalIndex j) {
    const Vec3 p = points[i], q = points[j];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  });
  std::vector<std::uint8_t> coincident(points.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (points[order[i]] == points[order[i - 1]]) coincident[order[i]] = coincident[order[i - 1]] = 1;
  }
  return made("different points have the same place", triangles_at(surface, coincident));
}

bool edge_meets(const TriangleSoup& surface, LocalIndex a, LocalIndex b, const Vec3 (&triangle)[3]) {
  return geometry::segment_meets_triangle(surface.points[a], surface.points[b], triangle);
}

/// Triangles with a common edge: they overlap when they are coplanar and on the same side of it.
bool fold_over(const TriangleSoup& surface, LocalIndex a, LocalIndex b, LocalIndex p, LocalIndex q) {
  const auto& x = surface.points;
  if (p == q) return true;
  if (geometry::orient3d(x[a], x[b], x[p], x[q]) != 0) return false;
  return dot(cross(x[b] - x[a], x[p] - x[a]), cross(x[b] - x[a], x[q] - x[a])) > 0;
}

bool meet_improperly(const TriangleSoup& surface, const BoundaryDistance::Triangle& s,
                     const BoundaryDistance::Triangle& t) {
  LocalIndex common[3], only_s[3], only_t[3];
  int commons = 0, onlys = 0, onlyt = 0;
  for (const LocalIndex v : s) {
    (std::find(t.begin(), t.end(), v) != t.end() ? common[commons++] : only_s[onlys++]) = v;
  }
  for (const LocalIndex v : t) {
    if (std::find(s.begin(), s.end(), v) == s.end()) only_t[onlyt++] = v;
  }
  const auto& x = surface.points;
  const Vec3 first[3] = {x[s[0]], x[s[1]], x[s[2]]}, second[3] = {x[t[0]], x[t[1]], x[t[2]]};
  switch (commons) {
    case 0:
      return geometry::triangles_intersect(first, second);
    case 1:
      return edge_meets(surface, only_s[0], only_s[1], second) ||
             edge_meets(surface, only_t[0], only_t[1], first);
    case 2:
      return fold_over(surface, common[0], common[1], only_s[0], only_t[0]);
    default:
      return true;
  }
}

}  // namespace

SurfaceDefect find_defect(const TriangleSoup& surface) {
  for (const auto find :
       {find_wild_indices, find_infinite_points, find_flat_triangles, find_coincident_points}) {
    if (SurfaceDefect defect = find(surface); !defect.what.empty()) return defect;
  }
  return {};
}

SurfaceDefect find_intersections(const TriangleSoup& surface, const BoundaryDistance& tree) {
  std::vector<std::int32_t> hit;
  tree.for_each_overlapping_pair([&](std::int32_t s, std::int32_t t) {
    if (!meet_improperly(surface, surface.triangles[s], surface.triangles[t])) return;
    hit.push_back(s);
    hit.push_back(t);
  });
  return made("the surface intersects itself", hit);
}

std::string describe_triangles(const TriangleSoup& surface, const std::vector<std::int32_t>& triangles) {
  constexpr std::size_t most = 10;  // in a message
  std::ostringstream text;
  for (std::size_t i = 0; i < std::min(triangles.size(), most); ++i) {
    const auto& t = surface.triangles[triangles[i]];
    text << "\n  triangle " << triangles[i];
    if (std::min({t[0], t[1], t[2]}) < 0 ||
        std::size_t(std::max({t[0], t[1], t[2]})) >= surface.points.size())
      continue;
    const Vec3 a = surface.points[t[0]], b = surface.points[t[1]], c = surface.points[t[2]];
    const Vec3 center = (1.0 / 3.0) * (a + b + c);
    const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
    text << " at " << geometry::place_text(center) << ", edges " << std::min({ab, bc, ca}) << " to "
         << std::max({ab, bc, ca});
  }
  if (triangles.size() > most) text << "\n  and " << triangles.size() - most << " more";
  return text.str();
}

}  // namespace aeroloom::volume
