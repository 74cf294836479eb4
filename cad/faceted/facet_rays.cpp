#include "cad/faceted/facet_rays.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::orient3d;

enum class Crossing { none, through, unclear };

/// How the segment pq passes a triangle.
Crossing crossing_of(Vec3 p, Vec3 q, const std::array<Vec3, 3>& t) {
  int least = 1, most = -1;
  for (int i = 0; i < 3; ++i) {
    const int side = orient3d(p, q, t[i], t[(i + 1) % 3]);
    least = std::min(least, side), most = std::max(most, side);
  }
  if (least < 0 && most > 0) return Crossing::none;
  const int at_p = orient3d(t[0], t[1], t[2], p), at_q = orient3d(t[0], t[1], t[2], q);
  if (at_p * at_q > 0) return Crossing::none;
  return at_p * at_q < 0 && least * most > 0 ? Crossing::through : Crossing::unclear;
}

/// Whether the segment from p to q may meet the box: by parameters, a little widened.
bool segment_near_box(Vec3 p, Vec3 q, const Box& box) {
  double from = 0, to = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = q[axis] - p[axis];
    if (step == 0) {
      if (p[axis] < box.low[axis] || p[axis] > box.high[axis]) return false;
      continue;
    }
    const double a = (box.low[axis] - p[axis]) / step, b = (box.high[axis] - p[axis]) / step;
    from = std::max(from, std::min(a, b) - 1e-9), to = std::min(to, std::max(a, b) + 1e-9);
  }
  return from <= to;
}

}  // namespace

FacetRays::FacetRays(const FacetSoup& soup) : _soup(soup) {
  std::vector<Box> boxes(soup.triangles.size());
  Box all;
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::int32_t corner : soup.triangles[t]) boxes[t].add(soup.points[corner]);
    all.add(boxes[t]);
  }
  _tree = geometry::BoxTree(boxes, 8);
  _reach = 2 * all.diagonal();
}

bool FacetRays::collect(Vec3 point, Vec3 end, std::int32_t from, std::vector<std::int32_t>& found) const {
  found.clear();
  bool clear = true;
  _tree.search([&](const Box& box) { return clear && segment_near_box(point, end, box); },
               [&](std::int32_t place) {
                 const std::int32_t t = _tree.order()[place];
                 if (t == from || !clear) return;
                 const Crossing crossing = crossing_of(point, end, corners_of(_soup, t));
                 if (crossing == Crossing::through) found.push_back(t);
                 if (crossing == Crossing::unclear) clear = false;
               });
  std::sort(found.begin(), found.end());
  return clear;
}

std::vector<std::int32_t> FacetRays::passed(Vec3 point, std::int32_t from, Vec3 direction) const {
  const Vec3 along = normalized(direction);
  const Vec3 aside = normalized(cross(along, std::abs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 third = cross(along, aside);
  std::vector<std::int32_t> found;
  constexpr int attempts = 64;
  for (int i = 0; i < attempts; ++i) {
    const double turn = 2.399963 * i, tilt = 0.9 * i / attempts;  // the golden angle: no two rays alike
    const Vec3 way = along + tilt * (std::cos(turn) * aside + std::sin(turn) * third);
    if (collect(point, point + (_reach / norm(way) + distance(point, _soup.points.front())) * way, from,
                found))
      return found;
  }
  throw CadError(
      fmt::format("{}: what encloses {} cannot be decided: all rays from there meet sides of triangles; "
                  "repair the triangles there",
                  _soup.file, place_in_file(point)));
}

}  // namespace aeroloom::cad
