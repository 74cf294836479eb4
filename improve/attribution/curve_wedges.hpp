/// The angles that the boundary encloses at mesh edges on CAD curves.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// An edge between vertices on curves, seen from one region.
struct EdgeName {
  mesh::GlobalIndex low, high;  ///< its vertices
  std::int64_t region;
  auto operator<=>(const EdgeName&) const = default;
};

/// The angle of a region at an edge, and the CAD faces on either side.
struct EdgeWedge {
  double angle = 0;                           ///< degrees; sum over the tetrahedra of the region
  std::array<std::int32_t, 2> faces{-1, -1};  ///< CAD faces of the boundary triangles there; -1: unknown
};

EdgeName name_edge(const mesh::Piece& piece, const std::vector<mesh::GlobalIndex>& names, mesh::LocalIndex a,
                   mesh::LocalIndex b);

/// The number of an edge in an ascending list, or -1.
std::int64_t find_edge(const std::vector<EdgeName>& edges, const EdgeName& edge);

/// Measures each edge of the list (ascending, equal on all ranks). Collective; equal on all ranks.
std::vector<EdgeWedge> measure_wedges(const mesh::NumberedMesh& mesh, const std::vector<EdgeName>& edges);

}  // namespace aeroloom::attribution
