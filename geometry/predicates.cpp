#include "geometry/predicates.hpp"

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
Kernel::Triangle_3 to_cgal(const Vec3 (&t)[3]) {
  return {to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2])};
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

int in_sphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  return CGAL::side_of_oriented_sphere(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d), to_cgal(e));
}

bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  return CGAL::do_intersect(to_cgal(a), to_cgal(b));
}

bool segment_meets_triangle(Vec3 p, Vec3 q, const Vec3 (&triangle)[3]) {
  return CGAL::do_intersect(Kernel::Segment_3(to_cgal(p), to_cgal(q)), to_cgal(triangle));
}

}  // namespace aeroloom::geometry
#include "geometry/domain.hpp"
