/// A wall triangle seen from one of its corners.
#pragma once

#include "layers/local_wall.hpp"
#include "mesh/checks/intersection.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// An edge of a path (ridge_paths.hpp), seen from one of its ends.
struct PathEdge {
  mesh::VertexName from, to;
  double turn = 0;  ///< least angle between the outer columns at `from`, in radians
};
/// By `from`, then `to`: of each path both directions of its edges.
using PathEdges = std::vector<PathEdge>;

inline bool precedes(const mesh::VertexName& a, const mesh::VertexName& b) {
  return a.piece != b.piece ? a.piece < b.piece : a.id < b.id;
}

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
