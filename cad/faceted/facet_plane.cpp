#include "cad/faceted/facet_plane.hpp"

#include "cad/faceted/facet_sides.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A cluster of triangles counts as a flat side if its area is at least this part of that of all. Chosen.
constexpr double least_flat_side = 1e-3;

FacetPlane facet_plane_at(const Box& box, int axis, double position, std::string reason) {
  FacetPlane plane{axis,
                   position,
                   true,
                   tolerances::on_symmetry * box.diagonal(),
                   tolerances::same_place * box.diagonal(),
                   std::move(reason),
                   box};
  plane.positive = box.high[axis] - position > std::min(plane.reach, position - box.low[axis]);
  return plane;
}

/// The angle between the outward normal of a triangle and the way to the plane, radians. Either side counts
/// as outward: files may have triangles turned round.
double tilt_of(const FacetSoup& soup, std::size_t triangle, const FacetPlane& plane) {
  Vec3 axis;
  axis[plane.axis] = 1;
  const Vec3 normal = area_vector2(corners_of(soup, triangle));
  const double tilt = geometry::angle_between(normal, axis);
  return std::min(tilt, std::numbers::pi - tilt);
}

class PlaneFinder {
public:
  explicit PlaneFinder(const FacetSoup& soup) : _soup(soup), _box(box_of_points(soup.points)) {}

  FacetPlane on_axis(int axis, const std::optional<double>& position) const {
    if (position) return reached(facet_plane_at(_box, axis, *position, "as requested"));
    FacetPlane open = best(axis, Score::open_sides), flat = best(axis, Score::flat_sides);
    if (score(open, Score::open_sides) > 0) return open;
    FacetPlane zero = facet_plane_at(_box, axis, 0, "the body reaches across it");
    if (_box.low[axis] < -zero.same && _box.high[axis] > zero.same && score(flat, Score::flat_sides) == 0)
      return zero;
    if (_box.low[axis] < -zero.reach && _box.high[axis] > zero.reach) return zero;
    const bool at_zero = std::abs(flat.position) <= zero.reach && score(flat, Score::flat_sides) > 0;
    if (!at_zero && std::min(std::abs(_box.low[axis]), std::abs(_box.high[axis])) <= zero.reach)
      refuse_missing_flat_sides(_soup, zero);
    if (score(flat, Score::flat_sides) > 0) return flat;
    throw CadError(fmt::format(
        "no plane of symmetry: the triangles reach from {} = {:.6g} to {:.6g} and end at neither in "
        "flat sides or open ones: give FarFieldOptions::symmetry_position",
        "xyz"[axis], in_file(_box.low[axis]), in_file(_box.high[axis])));
  }

  FacetPlane automatic() const {
    const double extent = _box.high.y - _box.low.y;
    if (std::abs(_box.high.y + _box.low.y) <= tolerances::symmetric * extent)
      return facet_plane_at(_box, 1, 0, "the body is symmetric about it");
    for (const Score kind : {Score::open_sides, Score::flat_sides}) {
      std::optional<FacetPlane> found;
      for (int axis = 0; axis < 3; ++axis) {
        const FacetPlane plane = facet_plane_at(_box, axis, 0, reason_of(kind));
        if (score(plane, kind) > (found ? score(*found, kind) : 0)) found = plane;
      }
      if (found) return *found;
    }
    throw CadError(
        "a hemisphere needs a plane of symmetry, but the body ends at no coordinate plane and is not "
        "symmetric about y = 0: give FarFieldOptions::symmetry and FarFieldOptions::symmetry_position");
  }

  /// Where more than half of all open sides lie.
  std::optional<FacetPlane> of_open_sides() const {
    double most = 0;
    for (const geometry::HalfEdge h : open_sides(_soup.triangles)) most += 0.5 * length_of(h);
    std::optional<FacetPlane> found;
    for (int axis = 0; axis < 3; ++axis) {
      const FacetPlane plane = best(axis, Score::open_sides);
      if (score(plane, Score::open_sides) > most) most = score(plane, Score::open_sides), found = plane;
    }
    return found;
  }

private:
  enum class Score { open_sides, flat_sides };

  static std::string reason_of(Score kind) {
    return kind == Score::open_sides ? "the body is open there" : "the body ends there in flat sides";
  }

  double length_of(geometry::HalfEdge h) const {
    return distance(_soup.points[side_begin(_soup.triangles, h)], _soup.points[side_end(_soup.triangles, h)]);
  }

  /// Length of the open sides, or area of the flat sides, within reach.
  double score(const FacetPlane& plane, Score kind) const {
    double sum = 0;
    if (kind == Score::flat_sides) {
      const std::vector<char> flat = flat_side_triangles(_soup, plane);
      for (std::size_t t = 0; t < flat.size(); ++t)
        if (flat[t] != 0) sum += 0.5 * norm(area_vector2(corners_of(_soup, t)));
      return sum;
    }
    const auto is_near = [&](std::int32_t p) {
      return std::abs(plane.height(_soup.points[p])) <= plane.reach;
    };
    for (const geometry::HalfEdge h : open_sides(_soup.triangles))
      if (is_near(side_begin(_soup.triangles, h)) && is_near(side_end(_soup.triangles, h)))
        sum += length_of(h);
    return sum;
  }

  FacetPlane best(int axis, Score kind) const {
    FacetPlane found = facet_plane_at(_box, axis, 0, reason_of(kind));
    double most = score(found, kind);
    for (const double position : {_box.low[axis], _box.high[axis]}) {
      if (most > 0 && std::abs(position) <= found.reach) continue;
      const FacetPlane plane = facet_plane_at(_box, axis, position, reason_of(kind));
      if (const double here = score(plane, kind); here > most) most = here, found = plane;
    }
    return found;
  }

  FacetPlane reached(FacetPlane plane) const {
    const double low = _box.low[plane.axis], high = _box.high[plane.axis];
    if (plane.position >= low - plane.reach && plane.position <= high + plane.reach) return plane;
    throw CadError(fmt::format(
        "the plane of symmetry {} misses the triangles, which reach from {:.6g} to {:.6g}, by more "
        "than the {:.3g} ({:.0e} of the diagonal) that a body is carried on to its plane: give "
        "FarFieldOptions::symmetry_position",
        name_of(plane), in_file(low), in_file(high), in_file(plane.reach), tolerances::on_symmetry));
  }

  const FacetSoup& _soup;
  Box _box;
};

}  // namespace

std::string name_of(const FacetPlane& plane) {
  return fmt::format("{} = {:.6g}", "xyz"[plane.axis], in_file(plane.position));
}

std::optional<FacetPlane> find_facet_plane(const FacetSoup& soup, const FarFieldOptions& options) {
  const bool half = options.shape == FarFieldShape::hemisphere;
  switch (options.symmetry) {
    case Symmetry::x:
    case Symmetry::y:
    case Symmetry::z:
      return PlaneFinder(soup).on_axis(static_cast<int>(options.symmetry) - static_cast<int>(Symmetry::x),
                                       options.symmetry_position);
    case Symmetry::automatic:
      if (half) return PlaneFinder(soup).automatic();
      return std::nullopt;
    case Symmetry::none:
      break;
  }
  if (half)
    throw CadError(
        "a hemisphere is half a far field: give FarFieldOptions::symmetry, or the sphere as its shape");
  return std::nullopt;
}

std::optional<FacetPlane> plane_of_open_sides(const FacetSoup& soup) {
  return PlaneFinder(soup).of_open_sides();
}

std::vector<char> flat_side_triangles(const FacetSoup& soup, const FacetPlane& plane) {
  std::vector<char> flat(soup.triangles.size(), 0);
  for (std::size_t t = 0; t < flat.size(); ++t) {
    const auto corners = corners_of(soup, t);
    const bool near =
        std::ranges::all_of(corners, [&](Vec3 p) { return std::abs(plane.height(p)) <= plane.reach; });
    flat[t] = near && tilt_of(soup, t, plane) <= tolerances::flat_side ? 1 : 0;
  }
  return flat;
}

void refuse_missing_flat_sides(const FacetSoup& soup, const FacetPlane& plane) {
  const std::vector<char> flat = flat_side_triangles(soup, plane);
  std::vector<char> facing(flat.size(), 0);
  double all = 0;
  for (std::size_t t = 0; t < flat.size(); ++t) {
    all += 0.5 * norm(area_vector2(corners_of(soup, t)));
    facing[t] = flat[t] == 0 && tilt_of(soup, t, plane) <= tolerances::wedge_at_symmetry ? 1 : 0;
  }
  geometry::DisjointSets<std::int32_t> sides(flat.size());
  for_each_side(sort_sides(soup.triangles), [&](std::span<const FacetSide> passes) {
    for (const FacetSide& pass : passes) {
      const std::int32_t a = facet_of(passes.front().half_edge), b = facet_of(pass.half_edge);
      if (facing[a] != 0 && facing[b] != 0) sides.unite(a, b);
    }
  });
  struct Side {
    double area = 0, nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    Vec3 normal, middle;
  };
  std::vector<Side> found(flat.size());
  for (std::size_t t = 0; t < flat.size(); ++t) {
    if (facing[t] == 0) continue;
    Side& side = found[sides.root(static_cast<std::int32_t>(t))];
    const Vec3 normal = area_vector2(corners_of(soup, t));
    side.normal += dot(normal, side.normal) < 0 ? -normal : normal;
    side.area += 0.5 * norm(normal);
    side.middle += 0.5 * norm(normal) * middle_of(soup, t);
    for (const Vec3 p : corners_of(soup, t)) {
      side.nearest = std::min(side.nearest, plane.height(p)),
      side.farthest = std::max(side.farthest, plane.height(p));
    }
  }
  const auto shown = [&](double length) { return in_file(std::abs(length) <= plane.same ? 0 : length); };
  for (const Side& side : found) {
    if (side.area < least_flat_side * all || side.nearest > plane.reach || side.farthest < -plane.reach)
      continue;
    Vec3 axis;
    axis[plane.axis] = 1;
    const double tilt = geometry::angle_between(side.normal, axis);
    throw CadError(fmt::format(
        "a flat side of the triangles, around {}, misses the plane of symmetry {}: it is tilted by {:.3g} "
        "degrees, and "
        "its distance goes from {:.3g} to {:.3g}, more than the {:.3g} ({:.0e} of the diagonal) that is put "
        "on the "
        "plane. Remedy: turn or move the body in the program that made it, or a "
        "FarFieldOptions::symmetry_position "
        "inside of the body, which cuts it there",
        place_in_file(side.middle / side.area), name_of(plane),
        std::min(tilt, std::numbers::pi - tilt) * geometry::degrees_per_radian, shown(side.nearest),
        shown(side.farthest), in_file(plane.reach), tolerances::on_symmetry));
  }
}

}  // namespace aeroloom::cad
