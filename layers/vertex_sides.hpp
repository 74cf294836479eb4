/// The parts of space around a vertex at which faces with something on both sides meet.
#pragma once

#include "mesh/checks/triangle_contact.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// A triangle seen from one of its corners, counter-clockwise seen from outside its front region.
struct SidedTriangle {
  mesh::VertexName next, previous;  ///< the corners after and before this one
  geometry::Vec3 next_point, previous_point;
  mesh::RegionId front = 0, back = mesh::no_region;
  mesh::PieceId piece = 0;
  mesh::LocalIndex cell = 0;

  bool is_inner() const { return back != mesh::no_region; }
};

/// By triangle, in the order given: the part that lies at its front and the one at its back; the latter is -1
/// where nothing does. Triangles around a vertex bound each part as a closed fan, or as several. Parts are
/// numbered by the lowest triangle, by piece and cell, at which they lie, its front first. All are 0 where
/// triangles contradict each other.
using VertexSides = std::vector<std::array<std::int32_t, 2>>;
VertexSides find_vertex_sides(geometry::Vec3 vertex, std::span<const SidedTriangle> star);

}  // namespace aeroloom::layers
