/// How far the next part of the boundary is.
#pragma once

#include "layers/local_wall.hpp"

#include <vector>

namespace aeroloom::layers {

/// A ball that touches the wall from the fluid side.
struct TouchingBall {
  geometry::Vec3 point;      ///< where it touches
  geometry::Vec3 direction;  ///< unit, to its centre
  double diameter = 0;       ///< at most; 0: not asked for
};

/// By vertex: the diameter of the largest ball that touches the wall at the vertex and holds no point of the
/// boundary's other triangles, those around the vertex left out; what was allowed at most where it is larger
/// (Ma, Bae and Choi, 3D medial axis point approximation using nearest neighbors and the normal field, The
/// Visual Computer 28, 2012, doi:10.1007/s00371-011-0594-7). Between parallel walls that is their distance,
/// in a corner of 90 degrees twice the distance from the other side. Triangles travel to the ranks of balls
/// that they may meet. The same for any number of ranks. Collective.
std::vector<double> find_gaps(const LocalWall& wall, const std::vector<TouchingBall>& balls);

/// The diameter of the largest ball that meets a triangle in its border alone, at most ball.diameter.
double diameter_beside(const TouchingBall& ball, const geometry::Vec3 (&triangle)[3]);

}  // namespace aeroloom::layers
