#include "sizing/sources/size_demands.hpp"

#include "sizing/sources/cells_where.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::sizing {

using geometry::Vec3;

namespace {

/// A point of the plane through the axis of a cylinder: along the axis, and off it.
struct InPlane {
  double along, off;
};

double distance_to_side(InPlane p, InPlane a, InPlane b) {
  const double x = b.along - a.along, y = b.off - a.off, length = x * x + y * y;
  const double t = length > 0 ? ((p.along - a.along) * x + (p.off - a.off) * y) / length : 0;
  const double c = std::clamp(t, 0.0, 1.0);
  return std::hypot(p.along - a.along - c * x, p.off - a.off - c * y);
}

double distance_to_cylinder(const SizeRegion& region, Vec3 p) {
  const Vec3 axis = region.end - region.start;
  const double length = norm(axis);
  if (length == 0) return std::max(0.0, distance(p, region.start) - region.start_radius);
  const Vec3 direction = (1 / length) * axis;
  const double along = dot(p - region.start, direction);
  const InPlane q{along, norm(p - region.start - along * direction)};
  const double radius =
      region.start_radius + (region.end_radius - region.start_radius) * std::clamp(along / length, 0.0, 1.0);
  if (along >= 0 && along <= length && q.off <= radius) return 0;
  const std::array<InPlane, 4> outline{
      {{0, 0}, {0, region.start_radius}, {length, region.end_radius}, {length, 0}}};
  double least = distance_to_side(q, outline[0], outline[1]);
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    least = std::min(least, distance_to_side(q, outline[i], outline[i + 1]));
  return least;
}

}  // namespace

double SizeRegion::distance_to(Vec3 p) const {
  if (shape == Shape::sphere) return std::max(0.0, distance(p, start) - start_radius);
  if (shape == Shape::cylinder) return distance_to_cylinder(*this, p);
  const geometry::Box around = box();
  Vec3 off;
  for (int axis = 0; axis < 3; ++axis)
    off[axis] = std::max({0.0, around.low[axis] - p[axis], p[axis] - around.high[axis]});
  return norm(off);
}

geometry::Box SizeRegion::box() const {
  geometry::Box result;
  const auto add = [&](Vec3 p, double radius) {
    result.add(p - Vec3{radius, radius, radius});
    result.add(p + Vec3{radius, radius, radius});
  };
  add(start, shape == Shape::box ? 0 : start_radius);
  if (shape != Shape::sphere) add(end, shape == Shape::box ? 0 : end_radius);
  return result;
}

namespace {

/// Of the size: two sources of a line are no farther apart.
constexpr double step_along = 0.5;

double steps_between(const SizeLine& line, std::size_t i, double coarser) {
  const double size = coarser * std::min(line.sizes[i], line.sizes[i + 1]);
  return std::ceil(std::max(1.0, distance(line.points[i], line.points[i + 1]) / (step_along * size)));
}

}  // namespace

double points_along(const SizeLine& line, double coarser) {
  double points = 1;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) points += steps_between(line, i, coarser);
  return points;
}

std::vector<SizeSource> sources_along(const RootCube& root, const SizeLine& line, double coarser) {
  std::vector<SizeSource> sources;
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const double steps = steps_between(line, i, coarser);
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
      const double part = k / steps;
      sources.push_back({line.points[i] + part * (line.points[i + 1] - line.points[i]),
                         coarser * (line.sizes[i] + part * (line.sizes[i + 1] - line.sizes[i]))});
    }
  }
  return thin_sources(root, sources);
}

std::vector<double> sizes_on_faces(const cad::Model& model, const SizeDemands& demands) {
  std::vector<double> sizes(model.face_count(), 0);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const std::string& patch = model.patches()[model.face(f).patch];
    for (const PatchSize& asked : demands.patches) {
      if (asked.patch == patch) sizes[f] = asked.size;
    }
  }
  return sizes;
}

double cells_in(const RootCube& root, const SizeRegion& region, double size) {
  const double edge = std::ldexp(root.edge, -root.level(size));
  const Vec3 high = root.low + Vec3{root.edge, root.edge, root.edge};
  const geometry::Box box = region.box();
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = std::min(box.high[axis], high[axis]) - std::max(box.low[axis], root.low[axis]);
    if (extent < 0) return 0;
    cells *= extent / edge + 1;
  }
  if (region.shape != SizeRegion::Shape::cylinder) return cells;
  const double radius = std::max(region.start_radius, region.end_radius) / edge + 1;
  return std::min(cells,
                  std::numbers::pi * radius * radius * (distance(region.start, region.end) / edge + 2));
}

std::vector<SizeSource> sources_in(const RootCube& root, const SizeRegion& region, double size, int rank,
                                   int ranks) {
  const auto ask = [&](Vec3 middle, double half) {
    if (region.distance_to(middle) > std::numbers::sqrt3 * half) return CubeDemand{};
    return CubeDemand{size, size};
  };
  return sources_where(root, ask, {rank, ranks});
}

}  // namespace aeroloom::sizing
