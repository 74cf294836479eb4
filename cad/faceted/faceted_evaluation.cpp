#include "cad/faceted/faceted_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace aeroloom::cad {
namespace {

/// The foot that a way over the facets leads to from the guess is taken, unless another part of the face is
/// nearer by more than this factor: between the two sides of a thin wing the guess knows better. Chosen, not
/// measured.
constexpr double most_over_nearest = 3;

/// Weights of the corners of a triangle of the plane at a point; the nearest place of the triangle for points
/// outside.
std::array<double, 3> weights_in(const CornerUv& corners, Vec2 p, double& away2) {
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const std::array<double, 3> inside{cross(corners[1] - p, corners[2] - p) / area,
                                     cross(corners[2] - p, corners[0] - p) / area,
                                     cross(corners[0] - p, corners[1] - p) / area};
  away2 = 0;
  if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) return inside;
  std::array<double, 3> best{};
  away2 = std::numeric_limits<double>::max();
  for (int i = 0; i < 3; ++i) {
    const Vec2 a = corners[i], side = corners[(i + 1) % 3] - a;
    const double length2 = dot(side, side);
    const double t = length2 > 0 ? std::clamp(dot(p - a, side) / length2, 0.0, 1.0) : 0;
    const Vec2 off = p - (a + t * side);
    if (dot(off, off) >= away2) continue;
    away2 = dot(off, off);
    best = {};
    best[i] = 1 - t, best[(i + 1) % 3] = t;
  }
  return best;
}

/// Weights of the nearest point of a triangle of space (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
std::array<double, 3> nearest_weights(const std::array<Vec3, 3>& corners, Vec3 p) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

double distance_to_box(const Box& box, Vec3 p) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
    sum += off * off;
  }
  return std::sqrt(sum);
}

}  // namespace

std::size_t FacetedGeometry::side_at(const FacetedEdge& edge, double parameter, double& fraction) const {
  const auto above = std::upper_bound(edge.along.begin() + 1, edge.along.end() - 1, parameter);
  const std::size_t side = static_cast<std::size_t>(above - edge.along.begin()) - 1;
  const double length = edge.along[side + 1] - edge.along[side];
  fraction = length > 0 ? std::clamp((parameter - edge.along[side]) / length, 0.0, 1.0) : 0;
  return side;
}

Vec3 FacetedGeometry::edge_point(EdgeId id, double parameter) const {
  const FacetedEdge& edge = _edges[id];
  double fraction = 0;
  const std::size_t side = side_at(edge, parameter, fraction);
  const Vec3 a = _complex.points[edge.points[side]], b = _complex.points[edge.points[side + 1]];
  if (fraction == 1) return b;
  Vec3 point = a + fraction * (b - a);
  for (int axis = 0; axis < 3; ++axis) {
    if (a[axis] == b[axis]) point[axis] = a[axis];
  }
  return point;
}

Vec3 FacetedGeometry::edge_tangent(EdgeId id, double parameter) const {
  const FacetedEdge& edge = _edges[id];
  double fraction = 0;
  const std::size_t side = side_at(edge, parameter, fraction);
  return normalized(_complex.points[edge.points[side + 1]] - _complex.points[edge.points[side]]);
}

double FacetedGeometry::edge_curvature(EdgeId id, double parameter) const {
  const FacetedEdge& edge = _edges[id];
  double fraction = 0;
  const std::size_t side = side_at(edge, parameter, fraction);
  return (1 - fraction) * edge.curvatures[side] + fraction * edge.curvatures[side + 1];
}

Vec2 FacetedGeometry::edge_uv(EdgeId id, FaceId face, double parameter) const {
  const FacetedEdge& edge = _edges[id];
  double fraction = 0;
  const std::size_t side = side_at(edge, parameter, fraction);
  for (const FacetedUse& use : edge.uses) {
    if (use.face != face) continue;
    const geometry::HalfEdge h = use.half_edges[side];
    Vec2 a = _uv[h / 3][h % 3], b = _uv[h / 3][(h % 3 + 1) % 3];
    if (use.reversed) std::swap(a, b);
    return (1 - fraction) * a + fraction * b;
  }
  throw std::out_of_range("an edge does not bound this face of facets");
}

FacetedGeometry::Place FacetedGeometry::locate(FaceId id, Vec2 uv) const {
  const FacetedFace& face = _faces[id];
  const std::int32_t wanted = face.first_sheet + sheet(id, uv);
  Place best;
  double bound = std::numeric_limits<double>::max();
  face.in_plane.search_nearest(
      [&](const Box& box) {
        return distance_to_box(box, {uv.x, uv.y, 0});
      },
      bound,
      [&](std::int32_t place) {
        const std::int32_t t = face.first + face.in_plane.order()[place];
        if (_sheets.of[t] != wanted) return;
        double away2 = 0;
        const auto weights = weights_in(_uv[t], uv, away2);
        const double away = std::sqrt(away2);
        // Of triangles that share a side the lower one, whatever the tree's order.
        if (away < bound || (away == bound && t < best.triangle)) {
          bound = away;
          best = {t, weights};
        }
      });
  return best;
}

Vec3 FacetedGeometry::point_at(const Place& place) const {
  const auto corners = corners_of(_complex, place.triangle);
  const auto& [a, b, c] = place.weights;
  Vec3 point = a * corners[0] + b * corners[1] + c * corners[2];
  for (int i = 0; i < 3; ++i) {
    if (place.weights[i] == 1) return corners[i];
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (corners[0][axis] == corners[1][axis] && corners[1][axis] == corners[2][axis])
      point[axis] = corners[0][axis];
  }
  return point;
}

Vec2 FacetedGeometry::uv_at(const Place& place) const {
  const CornerUv& uv = _uv[place.triangle];
  return place.weights[0] * uv[0] + place.weights[1] * uv[1] + place.weights[2] * uv[2];
}

Vec3 FacetedGeometry::face_point(FaceId id, Vec2 uv) const {
  return point_at(locate(id, uv));
}

SurfaceFrame FacetedGeometry::face_frame(FaceId id, Vec2 uv) const {
  const Place place = locate(id, uv);
  const auto p = corners_of(_complex, place.triangle);
  const CornerUv& at = _uv[place.triangle];
  const Vec2 first = at[1] - at[0], second = at[2] - at[0];
  const double area = cross(first, second);
  SurfaceFrame frame{point_at(place),
                     (second.y * (p[1] - p[0]) - first.y * (p[2] - p[0])) / area,
                     (first.x * (p[2] - p[0]) - second.x * (p[1] - p[0])) / area,
                     {}};
  const FacetedFace& face = _faces[id];
  Vec3 normal;
  for (int i = 0; i < 3; ++i)
    normal += place.weights[i] * face.shape.normals[face.triangles[place.triangle - face.first][i]];
  frame.normal = normalized(normal);
  return frame;
}

PrincipalCurvatures FacetedGeometry::face_curvatures(FaceId id, Vec2 uv) const {
  const FacetedFace& face = _faces[id];
  if (face.planar) return {0, 0, true};
  const Place place = locate(id, uv);
  PrincipalCurvatures found{0, 0, true};
  for (int i = 0; i < 3; ++i) {
    const auto& at = face.shape.curvatures[face.triangles[place.triangle - face.first][i]];
    found.largest += place.weights[i] * at.largest;
    found.smallest += place.weights[i] * at.smallest;
  }
  return found;
}

std::int32_t FacetedGeometry::sheet(FaceId id, Vec2 uv) const {
  const FacetedFace& face = _faces[id];
  const auto first = _sheets.sheets.begin() + face.first_sheet, last = first + face.sheet_count;
  const auto above =
      std::upper_bound(first, last, uv.x, [](double u, const FlatSheet& sheet) { return u < sheet.low; });
  if (above == first) return 0;
  const auto below = above - 1;
  const bool nearer_to_next = above != last && above->low - uv.x < uv.x - below->high;
  return static_cast<std::int32_t>((nearer_to_next ? above : below) - first);
}

FacetedGeometry::Foot FacetedGeometry::foot_on(std::int32_t triangle, Vec3 point) const {
  Foot foot{{triangle, nearest_weights(corners_of(_complex, triangle), point)}, {}, 0};
  foot.point = point_at(foot.place);
  foot.away = distance(foot.point, point);
  return foot;
}

/// From triangle to triangle around it, for as long as that leads nearer.
FacetedGeometry::Foot FacetedGeometry::descend(std::int32_t triangle, Vec3 point) const {
  Foot best = foot_on(triangle, point);
  for (bool nearer = true; nearer;) {
    nearer = false;
    const std::int32_t from = best.place.triangle;
    for (int corner = 0; corner < 3; ++corner) {
      if (best.place.weights[corner] == 0 && best.place.triangle == from) continue;
      // Both ways around the corner, for where the fan ends at a border.
      for (const bool left : {true, false}) {
        geometry::HalfEdge h = 3 * from + corner;
        while (true) {
          h = _links.inside[left ? geometry::previous_half_edge(h) : h];
          if (h >= 0 && !left) h = geometry::next_half_edge(h);
          if (h < 0 || h / 3 == from) break;
          const Foot foot = foot_on(h / 3, point);
          if (foot.away < best.away) best = foot, nearer = true;
        }
      }
    }
  }
  return best;
}

Projection FacetedGeometry::project(FaceId id, Vec3 point, Vec2 guess) const {
  const FacetedFace& face = _faces[id];
  const Foot local = descend(locate(id, guess).triangle, point);
  Foot nearest = local;
  double bound = local.away / most_over_nearest;
  face.in_space.search_nearest(
      [&](const Box& box) { return distance_to_box(box, point); }, bound,
      [&](std::int32_t place) {
        const std::int32_t t = face.first + face.in_space.order()[place];
        const Foot foot = foot_on(t, point);
        if (foot.away < bound || (foot.away == bound && t < nearest.place.triangle)) {
          bound = foot.away;
          nearest = foot;
        }
      });
  return {uv_at(nearest.place), nearest.point, true};
}

}  // namespace aeroloom::cad
