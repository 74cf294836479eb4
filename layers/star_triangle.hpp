/// A wall triangle seen from one of its corners.
#pragma once

#include "layers/local_wall.hpp"
#include "mesh/checks/intersection.hpp"

#include <cstdint>

namespace aeroloom::layers {

struct StarTriangle {
  geometry::Vec3 normal;      ///< unit, into the fluid
  geometry::Vec3 next_point;  ///< of the following corner, counter-clockwise seen from the fluid
  geometry::Vec3 previous_point;
  mesh::VertexName next, previous;  ///< the other two corners in order
  std::int32_t piece, cell, role, face, patch;
  std::int32_t edge_turn;  ///< EdgeTurn at the following corner

  WallRole wall_role() const { return static_cast<WallRole>(role); }
};

}  // namespace aeroloom::layers
