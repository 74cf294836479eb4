#include "mesh/quality/face_measures.hpp"

#include "mesh/quality/cell_measures.hpp"

#include <numbers>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

/// The least that faces extend along the normal to the centre of their cell, as a part of it: the cell
/// beyond, of the mirror, is as far away.
constexpr double share_at_boundary = 2 * share_inside;

Vec3 absolute(Vec3 a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

/// What is no number is as bad as can be.
double bounded(double ratio) {
  return ratio <= largest_ratio ? ratio : largest_ratio;
}

/// `line` is from the centre of the cell to that beyond, `share` the part of it that a face has at least.
double skewness_along(Vec3 line, double share, const FaceGeometry& face, std::span<const Vec3> corners,
                      Vec3 own) {
  const Vec3 miss = missed_along(line, face, own);
  const double length = norm(miss);
  const Vec3 direction = miss / (length + tiny_divisor);
  double extent = share * norm(line) + tiny_divisor;
  for (const Vec3& corner : corners)
    extent = std::max(extent, std::abs(dot(direction, corner - face.center)));
  return bounded(length / extent);
}

Vec3 sum_components(std::span<const FaceGeometry> faces) {
  Vec3 sums;
  for (const FaceGeometry& face : faces) sums += absolute(face.area);
  return sums;
}

/// The largest over the smallest.
double ratio_of_components(Vec3 sums) {
  const auto [least, most] = std::minmax({sums.x, sums.y, sums.z});
  return most / (least + tiny_divisor);
}

}  // namespace

FaceGeometry measure_face(std::span<const Vec3> p) {
  if (p.size() == 3) return measure_face(std::array{p[0], p[1], p[2]});
  return measure_face(std::array{p[0], p[1], p[2], p[3]});
}

double degrees_of_cosine(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

double skewness_inside(const FaceGeometry& face, std::span<const Vec3> corners, Vec3 own, Vec3 other) {
  return skewness_along(other - own, share_inside, face, corners, own);
}

double skewness_at_boundary(const FaceGeometry& face, std::span<const Vec3> corners, Vec3 own) {
  const Vec3 normal = normalized(face.area);
  return skewness_along(dot(normal, face.center - own) * normal, share_at_boundary, face, corners, own);
}

double aspect_ratio(std::span<const FaceGeometry> faces, double volume) {
  const Vec3 sums = sum_components(faces);
  const double root = std::cbrt(std::max(tiny_divisor, volume));
  return bounded(std::max(ratio_of_components(sums), (sums.x + sums.y + sums.z) / (6 * root * root)));
}

bool may_be_stretched(std::span<const FaceGeometry> faces, double volume, double limit) {
  const Vec3 sums = sum_components(faces);
  const double area = (sums.x + sums.y + sums.z) / (6 * limit), least = std::max(tiny_divisor, volume);
  return !(ratio_of_components(sums) < limit && area * area * area < surely * least * least);
}

double DeterminantSum::determinant() const {
  if (!(_lengths > 0)) return 0;
  const double mean = _lengths / _faces, scale = 1 / (mean * mean);
  const double xx = _xx * scale, yy = _yy * scale, zz = _zz * scale, xy = _xy * scale, xz = _xz * scale,
               yz = _yz * scale;
  const double value =
      std::abs(xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz));
  return std::isfinite(value) ? value / 8 : 0;
}

}  // namespace aeroloom::mesh
