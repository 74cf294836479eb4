/// Finds the neighbours across the edges of surface triangles, also on other ranks.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/report/picture/scene.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// The triangle on the other side of an edge.
struct EdgeNeighbour {
  geometry::Vec3 normal;   ///< unit normal of the neighbour; zero: no neighbour
  std::int32_t face = -1;  ///< its CAD face
  std::int32_t patch = -1;
  bool several = false;  ///< more than two triangles meet at the edge
  bool shown = false;    ///< whether the scene shows it

  bool is_open() const { return face < 0; }
};

/// By local piece: three for each triangle, across the edge from corner i to corner i + 1.
using EdgeNeighbours = std::vector<std::vector<EdgeNeighbour>>;

/// Matches edges within a piece locally and sends the others. Where more than two triangles meet, each gets
/// the next one in the order of pieces and triangles. Collective.
EdgeNeighbours find_edge_neighbours(const mesh::NumberedMesh& surface, const Shown& shown);

/// The turning angle of the surface at an edge, in radians. `edge` runs counter-clockwise around the triangle
/// with this normal. Positive: the wall is convex to the flow (leading edge); negative: a crease (wing and
/// fuselage).
double angle_at(geometry::Vec3 normal, geometry::Vec3 edge, const EdgeNeighbour& neighbour);

}  // namespace aeroloom::picture
