/// The directions in which columns of nodes grow from the wall.
#pragma once

#include "layers/bends.hpp"
#include "layers/curved_ends.hpp"
#include "layers/fans.hpp"

#include <vector>

namespace aeroloom::layers {

/// By column of the wall, and by vertex; zero where no column can grow. Equal in all pieces with a vertex.
struct Directions {
  std::vector<geometry::Vec3> most_normal;  ///< by column: axis of the smallest cone around the normals
  std::vector<geometry::Vec3> smoothed;     ///< by column: its unit direction
  std::vector<double>
      visibility;  ///< by vertex: smallest dot product of the smoothed direction with a normal
  /// Mean of the smallest and largest dot product of the smoothed direction with a normal. A column is longer
  /// than its height along the normals by about the inverse.
  std::vector<double> slants;
  EndPlaces ends;
  std::vector<Bend> bends;  ///< by column; empty: all are straight

  const Bend* bend_of(std::int32_t column) const {
    return bends.empty() || bends[column].is_straight() ? nullptr : &bends[column];
  }
};

/// Computes the most normal directions and smooths them. Smoothing keeps at least 0.9 of the visibility.
/// There is no direction if the most normal one makes less than 1.15 degrees with a triangle, or if layers
/// are not allowed. On planes that layers end on, directions lie in the plane. Those of fans stay.
/// Collective.
Directions find_directions(const LocalWall& wall, const VertexStars& stars, const Fans& fans);

}  // namespace aeroloom::layers
