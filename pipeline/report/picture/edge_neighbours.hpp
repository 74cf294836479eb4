/// Neighbours across the edges of the triangles of a surface mesh, on whatever rank.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/report/picture/scene.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::picture {

/// The triangle on the other side of an edge.
struct EdgeNeighbour {
  geometry::Vec3 normal;   ///< unit, as its own; zero where there is no triangle
  std::int32_t face = -1;  ///< CAD face
  std::int32_t patch = -1;
  bool several = false;  ///< more than two triangles meet: this is one of them
  bool shown = false;    ///< whether the scene shows it

  bool is_open() const { return face < 0; }
  static constexpr auto fields() {
    return std::tuple(&EdgeNeighbour::normal, &EdgeNeighbour::face, &EdgeNeighbour::patch,
                      &EdgeNeighbour::several, &EdgeNeighbour::shown);
  }
};

/// Per local piece, three for each triangle: over the edge from its corner i to corner i + 1.
using EdgeNeighbours = std::vector<std::vector<EdgeNeighbour>>;

/// Edges within a piece are matched there; those with one triangle in it travel. Where several triangles
/// of a piece, or several pieces with one each, meet, each gets the next one in the order of pieces and
/// triangles. Collective.
EdgeNeighbours find_edge_neighbours(const mesh::NumberedMesh& surface, const Shown& shown);

/// The angle in radians by which the surface turns at the edge with this direction, counter-clockwise around
/// a triangle with this normal: positive where the wall is convex for who stands in the flow, as at a leading
/// edge; negative in a crease, as between wing and fuselage.
double angle_at(geometry::Vec3 normal, geometry::Vec3 edge, const EdgeNeighbour& neighbour);

}  // namespace aeroloom::picture
