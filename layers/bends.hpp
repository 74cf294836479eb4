/// Columns over rows of stretched triangles. Straight ones would end as close together as the rows are; bent
/// ones spread over the room beside the rows, most of it over the edge that these begin at.
///
/// As marching methods do with ever smoother directions from layer to layer (Chan, Steger, Enhancements of a
/// three-dimensional hyperbolic grid generation scheme, Applied Mathematics and Computation 51, 1992), but in
/// closed form, so that a node follows from its column alone.
#pragma once

#include "layers/fans.hpp"
#include "layers/vertex_stars.hpp"

#include <algorithm>
#include <vector>

namespace aeroloom::layers {

/// How a column leaves its straight line: by nothing up to a height, above by a parabola.
struct Bend {
  geometry::Vec3 off;           ///< at right angles to the column: at `from` + `length`
  double from = 0, length = 1;  ///< heights along the column

  bool is_straight() const { return off == geometry::Vec3{}; }
  geometry::Vec3 at(double height) const {
    const double above = std::max(0.0, height - from) / length;
    return above * above * off;
  }
};

/// What bends follow from.
struct BendNeeds {
  const std::vector<double>& heights;             ///< by vertex: of columns, straight ones
  const std::vector<double>& edges;               ///< smooth_mean_edges()
  const std::vector<geometry::Vec3>& directions;  ///< by column, unit vectors
};

/// By column; nothing where no triangle is stretched. Over triangles much longer than wide, edges of the
/// front grow towards 0.45 of the long side. Columns bend above a fifth of their height, by 15 degrees at
/// most at half of it, by 35 at their ends, and less where heights differ along the wall. Those within fans,
/// at rims of curved faces and beside other triangles alone stay straight. Collective.
std::vector<Bend> find_bends(const LocalWall& wall, const VertexStars& stars, const Fans& fans,
                             const BendNeeds& needs);

}  // namespace aeroloom::layers
