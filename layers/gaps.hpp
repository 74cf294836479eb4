/// Distances from wall vertices to the opposite boundary.
#pragma once

#include "layers/local_wall.hpp"

#include <vector>

namespace aeroloom::layers {

/// A ball that touches the wall from the fluid side.
struct TouchingBall {
  geometry::Vec3 point;      ///< where it touches
  geometry::Vec3 direction;  ///< unit, to its centre
  double diameter = 0;       ///< upper bound; 0: no ball wanted
};

/// Measures the gap at each vertex: the diameter of the largest ball that touches the wall there and contains
/// no point of other boundary triangles. Triangles around the vertex do not count. The result is at most
/// ball.diameter (Ma, Bae and Choi, 3D medial axis point approximation using nearest neighbors and the normal
/// field, The Visual Computer 28, 2012, doi:10.1007/s00371-011-0594-7). Between parallel walls it is their
/// distance; in a corner of 90 degrees, twice the distance to the other side. Walls that turn by less than 47
/// degrees, where columns of both sides rise together, are no gap. Triangles are sent to the ranks
/// whose balls they may meet. Independent of the number of ranks. Collective.
std::vector<double> find_gaps(const LocalWall& wall, const std::vector<TouchingBall>& balls);

/// The diameter of the largest such ball that has no point of the triangle inside, at most ball.diameter.
double diameter_beside(const TouchingBall& ball, const geometry::Vec3 (&triangle)[3]);

}  // namespace aeroloom::layers
