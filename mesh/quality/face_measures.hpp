/// Faces and cells as solvers with unknowns at the centres of cells see them, one at a time. The definitions
/// are those of OpenFOAM v1912 and its program checkMesh (primitiveMeshTools, polyMeshTools), so figures can
/// be compared digit by digit.
#pragma once

#include "geometry/vec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace aeroloom::mesh {

/// What OpenFOAM adds to divisors (ROOTVSMALL in double precision), and the least volume (VSMALL).
inline constexpr double tiny_divisor = 1e-150, least_volume = 1e-300;

/// A face that need not be plane.
struct FaceGeometry {
  geometry::Vec3 center;
  geometry::Vec3 area;  ///< vector; its length is the area where the face is plane
};
struct CellGeometry {
  geometry::Vec3 center;
  double volume = 0;  ///< negative where the cell is inside out
};

/// Corners, three or four, are counter-clockwise as seen from where the area vector points to. A
/// quadrilateral is four triangles around the mean of its corners: its centre is the mean of theirs, weighted
/// by area, and its area vector the sum of theirs.
FaceGeometry measure_face(std::span<const geometry::Vec3> corners);
inline FaceGeometry measure_face(const std::array<geometry::Vec3, 3>& p) {
  return {(p[0] + p[1] + p[2]) / 3, 0.5 * cross(p[1] - p[0], p[2] - p[0])};
}
inline FaceGeometry measure_face(const std::array<geometry::Vec3, 4>& p) {
  const geometry::Vec3 middle = (p[0] + p[1] + p[2] + p[3]) / 4;
  std::array<double, 4> areas;
  std::array<geometry::Vec3, 4> normal;
  for (std::size_t k = 0; k < 4; ++k) {
    normal[k] = cross(p[(k + 1) % 4] - p[k], middle - p[k]);
    areas[k] = norm(normal[k]);
  }
  const double area = areas[0] + areas[1] + areas[2] + areas[3];
  if (!(area >= tiny_divisor)) return {middle, {}};
  geometry::Vec3 normals, centers;
  for (std::size_t k = 0; k < 4; ++k) {
    normals += normal[k];
    centers += areas[k] * (p[k] + p[(k + 1) % 4] + middle);
  }
  return {centers / (3 * area), 0.5 * normals};
}

/// `faces` are all of the cell, with area vectors out of it. The cell is a pyramid over each face from the
/// mean of the faces' centres; its centre is the mean of the pyramids' centroids, weighted by their signed
/// volumes.
inline CellGeometry measure_cell(std::span<const FaceGeometry> faces) {
  geometry::Vec3 estimate;
  for (const FaceGeometry& face : faces) estimate += face.center;
  estimate = estimate / static_cast<double>(faces.size());
  geometry::Vec3 moment;
  double volume3 = 0;
  for (const FaceGeometry& face : faces) {
    const double share = dot(face.area, face.center - estimate);
    moment += share * (0.75 * face.center + 0.25 * estimate);
    volume3 += share;
  }
  return {std::abs(volume3) > least_volume ? moment / volume3 : estimate, volume3 / 3};
}

/// Cosine of the angle between the area vector of an inner face and the line from the centre of its cell to
/// that of the cell beyond: 1 is orthogonal, negative above 90 degrees.
inline double cosine_at_face(geometry::Vec3 area, geometry::Vec3 own, geometry::Vec3 other) {
  const geometry::Vec3 line = other - own;
  const double cosine = dot(line, area) / (norm(line) * norm(area) + least_volume);
  return std::isfinite(cosine) ? cosine : -1;
}
/// Of a cosine, which may be a little off its range; 0 to 180.
double degrees_of_cosine(double cosine);

/// How far the line between both centres passes by the centre of the face, over the extent of the face in
/// that direction (from its centre to its corners, or a fifth of the line where that is more).
double skewness_inside(const FaceGeometry& face, std::span<const geometry::Vec3> corners, geometry::Vec3 own,
                       geometry::Vec3 other);
/// The least that faces extend, as a part of the line between the centres.
inline constexpr double share_inside = 0.2;
/// What is below a bound by more than this, of 1, is below it whatever is rounded.
inline constexpr double surely = 1 - 1e-9;
/// From where the line, moved to the centre of the cell, meets the plane of the face to the face's centre.
inline geometry::Vec3 missed_along(geometry::Vec3 line, const FaceGeometry& face, geometry::Vec3 own) {
  const geometry::Vec3 to_face = face.center - own;
  return to_face - (dot(face.area, to_face) / (dot(face.area, line) + tiny_divisor)) * line;
}
/// Whether skewness_inside() may reach `limit`: false only where it is surely below. Takes no root.
inline bool may_be_skewed(const FaceGeometry& face, std::span<const geometry::Vec3> corners,
                          geometry::Vec3 own, geometry::Vec3 other, double limit) {
  const geometry::Vec3 line = other - own, miss = missed_along(line, face, own);
  const double squared = dot(miss, miss), of_line = limit * share_inside;
  if (squared < surely * of_line * of_line * dot(line, line)) return false;
  double extent = 0;  // times the length of the miss
  for (const geometry::Vec3& corner : corners)
    extent = std::max(extent, std::abs(dot(miss, corner - face.center)));
  return !(squared < surely * limit * extent);
}
/// Of a face with one cell: the line is the normal from the plane of the face to the centre of the cell, as
/// if the cell were mirrored.
double skewness_at_boundary(const FaceGeometry& face, std::span<const geometry::Vec3> corners,
                            geometry::Vec3 own);

/// From the sums of the absolute components of all area vectors of a cell: the largest over the smallest, or
/// a sixth of all three over volume^(2/3) where that is more. 1 of a cube along the axes; it depends on how
/// the cell lies.
double aspect_ratio(std::span<const FaceGeometry> faces, double volume);
/// Whether it may reach `limit`, as may_be_skewed().
bool may_be_stretched(std::span<const FaceGeometry> faces, double volume, double limit);

/// How well the inner faces of a cell determine a gradient in it: an eighth of the determinant of the sum of
/// a a^T over their area vectors a, each divided by their mean length. 1 of a cube; 0 where they do not span
/// the space, as of a cell with boundary faces on all other sides.
class DeterminantSum {
public:
  void add(geometry::Vec3 area) {
    const double length = norm(area);
    _lengths += length;
    ++_faces;
    _xx += area.x * area.x, _yy += area.y * area.y, _zz += area.z * area.z;
    _xy += area.x * area.y, _xz += area.x * area.z, _yz += area.y * area.z;
  }
  double determinant() const;

private:
  int _faces = 0;
  double _lengths = 0;
  double _xx = 0, _yy = 0, _zz = 0, _xy = 0, _xz = 0, _yz = 0;
};

/// Smaller over larger of the volumes of two cells, at most 1 of positive ones; not positive where one is
/// not.
inline double volume_fraction(double a, double b) {
  const double fraction = std::min(a, b) / (std::max(a, b) + least_volume);
  return std::isfinite(fraction) ? fraction : 0;
}

}  // namespace aeroloom::mesh
