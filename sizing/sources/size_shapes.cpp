#include "sizing/sources/size_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace aeroloom::sizing {

using geometry::Vec3;

namespace {

constexpr double those_of_its_box = std::numeric_limits<double>::infinity();

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

double distance_to_ball(Vec3 center, double radius, Vec3 p) {
  return std::max(0.0, distance(p, center) - radius);
}

double distance_to_cone(const ConeShape& cone, Vec3 p) {
  const Vec3 axis = cone.to - cone.from;
  const double length = norm(axis);
  if (length == 0) return distance_to_ball(cone.from, cone.radius, p);
  const Vec3 direction = (1 / length) * axis;
  const double along = dot(p - cone.from, direction);
  const InPlane q{along, norm(p - cone.from - along * direction)};
  const double radius = cone.radius + (cone.end_radius - cone.radius) * std::clamp(along / length, 0.0, 1.0);
  if (along >= 0 && along <= length && q.off <= radius) return 0;
  const std::array<InPlane, 4> outline{{{0, 0}, {0, cone.radius}, {length, cone.end_radius}, {length, 0}}};
  double least = distance_to_side(q, outline[0], outline[1]);
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    least = std::min(least, distance_to_side(q, outline[i], outline[i + 1]));
  return least;
}

void add_ball(geometry::Box& box, Vec3 center, double radius) {
  box.add(center - Vec3{radius, radius, radius});
  box.add(center + Vec3{radius, radius, radius});
}

/// Of a cylinder around it, for cubes that cross its surface too.
double cells_around_axis(Vec3 from, Vec3 to, double largest_radius, double edge) {
  const double radius = largest_radius / edge + 1;
  return std::numbers::pi * radius * radius * (distance(from, to) / edge + 2);
}

ConeShape as_cone(const LineShape& line) {
  return {line.from, line.to, 0, 0};
}

ConeShape as_cone(const CylinderShape& cylinder) {
  return {cylinder.from, cylinder.to, cylinder.radius, cylinder.radius};
}

}  // namespace

double PointShape::distance_to(Vec3 p) const {
  return distance_to_ball(center, 0, p);
}

geometry::Box PointShape::box() const {
  geometry::Box box;
  box.add(center);
  return box;
}

double PointShape::cells(double /*edge*/) const {
  return those_of_its_box;
}

PointShape PointShape::scaled(double factor) const {
  return {factor * center};
}

double LineShape::distance_to(Vec3 p) const {
  return distance_to_cone(as_cone(*this), p);
}

geometry::Box LineShape::box() const {
  return as_cone(*this).box();
}

double LineShape::cells(double edge) const {
  return cells_around_axis(from, to, 0, edge);
}

LineShape LineShape::scaled(double factor) const {
  return {factor * from, factor * to};
}

double SphereShape::distance_to(Vec3 p) const {
  return distance_to_ball(center, radius, p);
}

geometry::Box SphereShape::box() const {
  geometry::Box box;
  add_ball(box, center, radius);
  return box;
}

double SphereShape::cells(double /*edge*/) const {
  return those_of_its_box;
}

SphereShape SphereShape::scaled(double factor) const {
  return {factor * center, factor * radius};
}

double BoxShape::distance_to(Vec3 p) const {
  const geometry::Box around = box();
  Vec3 off;
  for (int axis = 0; axis < 3; ++axis)
    off[axis] = std::max({0.0, around.low[axis] - p[axis], p[axis] - around.high[axis]});
  return norm(off);
}

geometry::Box BoxShape::box() const {
  geometry::Box box;
  box.add(low);
  box.add(high);
  return box;
}

double BoxShape::cells(double /*edge*/) const {
  return those_of_its_box;
}

BoxShape BoxShape::scaled(double factor) const {
  return {factor * low, factor * high};
}

double CylinderShape::distance_to(Vec3 p) const {
  return distance_to_cone(as_cone(*this), p);
}

geometry::Box CylinderShape::box() const {
  return as_cone(*this).box();
}

double CylinderShape::cells(double edge) const {
  return cells_around_axis(from, to, radius, edge);
}

CylinderShape CylinderShape::scaled(double factor) const {
  return {factor * from, factor * to, factor * radius};
}

double ConeShape::distance_to(Vec3 p) const {
  return distance_to_cone(*this, p);
}

geometry::Box ConeShape::box() const {
  geometry::Box box;
  add_ball(box, from, radius);
  add_ball(box, to, end_radius);
  return box;
}

double ConeShape::cells(double edge) const {
  return cells_around_axis(from, to, std::max(radius, end_radius), edge);
}

ConeShape ConeShape::scaled(double factor) const {
  return {factor * from, factor * to, factor * radius, factor * end_radius};
}

WakeShape WakeShape::scaled(double factor) const {
  WakeShape result = *this;
  if (result.from) result.from = factor * *result.from;
  if (result.to) result.to = factor * *result.to;
  result.length *= factor;
  if (result.end_size) *result.end_size *= factor;
  return result;
}

double distance_to(const SolidShape& shape, Vec3 p) {
  return std::visit([&](const auto& each) { return each.distance_to(p); }, shape);
}

geometry::Box box_of(const SolidShape& shape) {
  return std::visit([](const auto& each) { return each.box(); }, shape);
}

double cells_of(const SolidShape& shape, double edge) {
  return std::visit([&](const auto& each) { return each.cells(edge); }, shape);
}

SizeShape scaled(const SizeShape& shape, double factor) {
  return std::visit([&](const auto& each) -> SizeShape { return each.scaled(factor); }, shape);
}

}  // namespace aeroloom::sizing
