/// Faces and cells as solvers with unknowns at the centres of cells see them, one at a time. The definitions
/// are those of OpenFOAM v1912 and its program checkMesh (primitiveMeshTools, polyMeshTools), so figures can
/// be compared digit by digit.
#pragma once

#include "geometry/vec.hpp"

#include <span>

namespace aeroloom::mesh {

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

/// `faces` are all of the cell, with area vectors out of it. The cell is a pyramid over each face from the
/// mean of the faces' centres; its centre is the mean of the pyramids' centroids, weighted by their signed
/// volumes.
CellGeometry measure_cell(std::span<const FaceGeometry> faces);

/// Cosine of the angle between the area vector of an inner face and the line from the centre of its cell to
/// that of the cell beyond: 1 is orthogonal, negative above 90 degrees.
double cosine_at_face(geometry::Vec3 area, geometry::Vec3 own, geometry::Vec3 other);
/// Of a cosine, which may be a little off its range; 0 to 180.
double degrees_of_cosine(double cosine);

/// How far the line between both centres passes by the centre of the face, over the extent of the face in
/// that direction (from its centre to its corners, or a fifth of the line where that is more).
double skewness_inside(const FaceGeometry& face, std::span<const geometry::Vec3> corners, geometry::Vec3 own,
                       geometry::Vec3 other);
/// Of a face with one cell: the line is the normal from the plane of the face to the centre of the cell, as
/// if the cell were mirrored.
double skewness_at_boundary(const FaceGeometry& face, std::span<const geometry::Vec3> corners,
                            geometry::Vec3 own);

/// From the sums of the absolute components of all area vectors of a cell: the largest over the smallest, or
/// a sixth of all three over volume^(2/3) where that is more. 1 of a cube along the axes; it depends on how
/// the cell lies.
double aspect_ratio(std::span<const FaceGeometry> faces, double volume);

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
double volume_fraction(double a, double b);

}  // namespace aeroloom::mesh
