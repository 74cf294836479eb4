/// Edges at which a surface pinches itself.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <vector>

namespace aeroloom::surface {

/// An edge of one piece with more than two of its triangles, or of two triangles with the same corners.
struct PinchedEdge {
  mesh::PieceId piece;
  geometry::Vec3 middle;
  double length;
};

/// The pinched edges of all pieces, in the order of pieces; the same on every rank. Where two or three
/// elements go around a hole, two edges of it may join the same vertices on either way around. No triangle
/// crosses another one there, but the surface is none. Collective.
std::vector<PinchedEdge> find_pinched_edges(const mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
