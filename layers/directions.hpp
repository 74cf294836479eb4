/// Directions of columns.
#pragma once

#include "layers/vertex_stars.hpp"

#include <vector>

namespace aeroloom::layers {

/// By vertex of the wall; zero vectors where there is none. Equal in all pieces that know a vertex.
struct Directions {
  std::vector<geometry::Vec3> most_normal;  ///< axis of the smallest cone around the normals
  std::vector<geometry::Vec3> smoothed;     ///< unit: of the columns
  std::vector<double> visibility;           ///< smallest dot product of the smoothed one with a normal
  /// The mean of its smallest and largest dot product with a normal: columns are longer than their height
  /// along the normals by about the inverse.
  std::vector<double> slants;
};

/// The most normal directions, and these after sweeps of smoothing that see every triangle nearly as well as
/// they. A vertex whose most normal direction stands lower than 1.15 degrees on a triangle has none, nor have
/// those where layers may not be. On planes that layers end on, directions lie in them. Collective.
Directions find_directions(const LocalWall& wall, const VertexStars& stars);

}  // namespace aeroloom::layers
