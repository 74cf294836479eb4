#include "geometry/predicates.hpp"

#include <variant>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace aeroloom::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_cgal(Vec2 p) {
  return {p.x, p.y};
}
Kernel::Point_3 to_cgal(Vec3 p) {
  return {p.x, p.y, p.z};
}

/// A triangle as the point set it is: CGAL asks for segments and triangles that are not degenerate.
using Simplex = std::variant<Kernel::Point_3, Kernel::Segment_3, Kernel::Triangle_3>;

Simplex make_simplex(Vec3 p, Vec3 q) {
  if (p == q) return to_cgal(p);
  return Kernel::Segment_3(to_cgal(p), to_cgal(q));
}

Simplex make_simplex(const Vec3 (&t)[3]) {
  const auto a = to_cgal(t[0]), b = to_cgal(t[1]), c = to_cgal(t[2]);
  if (!CGAL::collinear(a, b, c)) return Kernel::Triangle_3(a, b, c);
  if (CGAL::collinear_are_ordered_along_line(a, b, c)) return make_simplex(t[0], t[2]);
  if (CGAL::collinear_are_ordered_along_line(b, a, c)) return make_simplex(t[1], t[2]);
  return make_simplex(t[0], t[1]);
}

bool meet(const Kernel::Point_3& p, const Kernel::Point_3& q) {
  return p == q;
}
template <class Shape>
bool meet(const Kernel::Point_3& p, const Shape& shape) {
  return shape.has_on(p);
}
template <class Shape>
bool meet(const Shape& shape, const Kernel::Point_3& p) {
  return shape.has_on(p);
}
template <class First, class Second>
bool meet(const First& first, const Second& second) {
  return CGAL::do_intersect(first, second);
}

bool meet(const Simplex& first, const Simplex& second) {
  return std::visit([](const auto& a, const auto& b) { return meet(a, b); }, first, second);
}

}  // namespace

int orient2d(Vec2 a, Vec2 b, Vec2 c) {
  return CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c));
}

int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d));
}

int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return CGAL::side_of_oriented_circle(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d));
}

bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  return meet(make_simplex(a), make_simplex(b));
}

bool segment_meets_triangle(Vec3 p, Vec3 q, const Vec3 (&triangle)[3]) {
  return meet(make_simplex(p, q), make_simplex(triangle));
}

}  // namespace aeroloom::geometry
