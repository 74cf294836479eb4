#include "mesh/quality/face_measures.hpp"

#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

/// What OpenFOAM adds to divisors (ROOTVSMALL in double precision), and the least volume (VSMALL).
constexpr double tiny = 1e-150, least_volume = 1e-300;

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
  const Vec3 to_face = face.center - own;
  const Vec3 miss = to_face - (dot(face.area, to_face) / (dot(face.area, line) + tiny)) * line;
  const double length = norm(miss);
  const Vec3 direction = miss / (length + tiny);
  double extent = share * norm(line) + tiny;
  for (const Vec3& corner : corners)
    extent = std::max(extent, std::abs(dot(direction, corner - face.center)));
  return bounded(length / extent);
}

}  // namespace

FaceGeometry measure_face(std::span<const Vec3> p) {
  if (p.size() == 3) return {(p[0] + p[1] + p[2]) / 3, 0.5 * cross(p[1] - p[0], p[2] - p[0])};
  const Vec3 middle = (p[0] + p[1] + p[2] + p[3]) / 4;
  Vec3 normals, centers;
  double areas = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 from = p[k], to = p[(k + 1) % 4];
    const Vec3 normal = cross(to - from, middle - from);
    const double area = norm(normal);
    normals += normal;
    areas += area;
    centers += area * (from + to + middle);
  }
  if (!(areas >= tiny)) return {middle, {}};
  return {centers / (3 * areas), 0.5 * normals};
}

CellGeometry measure_cell(std::span<const FaceGeometry> faces) {
  Vec3 estimate;
  for (const FaceGeometry& face : faces) estimate += face.center;
  estimate = estimate / static_cast<double>(faces.size());
  Vec3 moment;
  double volume3 = 0;
  for (const FaceGeometry& face : faces) {
    const double share = dot(face.area, face.center - estimate);
    moment += share * (0.75 * face.center + 0.25 * estimate);
    volume3 += share;
  }
  return {std::abs(volume3) > least_volume ? moment / volume3 : estimate, volume3 / 3};
}

double cosine_at_face(Vec3 area, Vec3 own, Vec3 other) {
  const Vec3 line = other - own;
  const double cosine = dot(line, area) / (norm(line) * norm(area) + least_volume);
  return std::isfinite(cosine) ? cosine : -1;
}

double degrees_of_cosine(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

double skewness_inside(const FaceGeometry& face, std::span<const Vec3> corners, Vec3 own, Vec3 other) {
  constexpr double share = 0.2;
  return skewness_along(other - own, share, face, corners, own);
}

double skewness_at_boundary(const FaceGeometry& face, std::span<const Vec3> corners, Vec3 own) {
  constexpr double share = 0.4;  // the cell beyond, of the mirror, is as far away
  const Vec3 normal = normalized(face.area);
  return skewness_along(dot(normal, face.center - own) * normal, share, face, corners, own);
}

double aspect_ratio(std::span<const FaceGeometry> faces, double volume) {
  Vec3 sums;
  for (const FaceGeometry& face : faces) sums += absolute(face.area);
  const auto [least, most] = std::minmax({sums.x, sums.y, sums.z});
  const double root = std::cbrt(std::max(tiny, volume));
  return bounded(std::max(most / (least + tiny), (sums.x + sums.y + sums.z) / (6 * root * root)));
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

double volume_fraction(double a, double b) {
  const double fraction = std::min(a, b) / (std::max(a, b) + least_volume);
  return std::isfinite(fraction) ? fraction : 0;
}

}  // namespace aeroloom::mesh
