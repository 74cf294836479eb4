#include "cad/faceted/facet_meeting.hpp"

#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_rays.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace aeroloom::cad {
namespace {

using geometry::Box;
using geometry::Vec3;
using FacetCorners = std::array<Vec3, 3>;

std::vector<Box> facet_boxes(const FacetSoup& soup) {
  std::vector<Box> boxes(soup.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const Vec3 p : corners_of(soup, t)) boxes[t].add(p);
  }
  return boxes;
}

double distance_of_segments(Vec3 p, Vec3 p_end, Vec3 q, Vec3 q_end) {
  const Vec3 u = p_end - p, v = q_end - q, w = p - q;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0 ? std::clamp((uv * vw - vv * uw) / determinant, 0.0, 1.0) : 0;
  const double t = vv > 0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0;
  s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
  return norm(w + s * u - t * v);
}

/// From a point to a triangle whose plane it falls into inside; infinite where it does not.
double height_over(const FacetCorners& triangle, Vec3 point) {
  const Vec3 normal = area_vector2(triangle);
  for (int i = 0; i < 3; ++i) {
    const Vec3 side = triangle[(i + 1) % 3] - triangle[i];
    if (dot(cross(normal, side), point - triangle[i]) < 0) return INFINITY;
  }
  return std::abs(dot(point - triangle[0], normal)) / norm(normal);
}

/// Of triangles that share no point.
double distance_of_triangles(const FacetCorners& a, const FacetCorners& b) {
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    least = std::min({least, height_over(a, b[i]), height_over(b, a[i])});
    for (int j = 0; j < 3; ++j)
      least = std::min(least, distance_of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return least;
}

bool share_a_point(const FacetCorners& a, const FacetCorners& b) {
  return geometry::triangles_intersect({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
}

}  // namespace

MeetingPlace find_meeting(const FacetSoup& a, const FacetSoup& b, double clearance) {
  const std::vector<Box> boxes = facet_boxes(a);
  const geometry::BoxTree tree(boxes, 8);
  const std::vector<Box> others = facet_boxes(b);
  MeetingPlace found;
  for (std::size_t t = 0; t < others.size() && found.meeting != FacetMeeting::crossing; ++t) {
    const FacetCorners other = corners_of(b, t);
    geometry::for_each_overlap(tree, boxes, others[t].dilated(clearance), [&](std::int32_t i) {
      if (found.meeting == FacetMeeting::crossing) return;
      const FacetCorners own = corners_of(a, i);
      if (boxes[i].overlaps(others[t]) && share_a_point(own, other))
        found = {FacetMeeting::crossing, middle_of(b, t)};
      else if (found.meeting == FacetMeeting::apart && distance_of_triangles(own, other) < clearance)
        found = {FacetMeeting::near, middle_of(b, t)};
    });
  }
  return found;
}

bool encloses(const FacetSoup& soup, Vec3 point) {
  const FacetComponents components = find_components(soup);
  std::vector<char> inside(components.count, 0);
  for (const std::int32_t t : FacetRays(soup).passed(point, -1, {0.29, 0.53, 0.8}))
    inside[components.of[t]] ^= 1;
  return std::find(inside.begin(), inside.end(), 1) != inside.end();
}

}  // namespace aeroloom::cad
