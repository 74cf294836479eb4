/// Cavities across pieces. Tetrahedra around chosen vertices are taken out of their pieces, collected on one
/// rank, replaced, and returned to the pieces. Pieces change their outlines by this. The result does not
/// depend on the number of ranks.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace aeroloom::cavities {

/// A cavity's number; it depends only on the mesh.
using CavityId = std::uint64_t;
inline constexpr CavityId no_cavity = 0;

/// The cavity at a place: the cell of a grid. Cells are between `width` and 8 `width` times as wide as
/// `size`, because sizes may vary a lot within a cell. Another `shift` moves the borders of the grid.
CavityId cavity_at(geometry::Vec3 p, double size, double width, int shift);

/// A surface triangle on the boundary of a cavity.
struct CavityTriangle {
  std::array<mesh::LocalIndex, 3> vertices;
  std::int32_t face, patch;
};

/// A cavity before its replacement. Vertices have local numbers: shared ones are ordered by key, others by
/// piece. So their order does not depend on ranks.
struct Cavity {
  CavityId id = no_cavity;
  mesh::RegionId region = 0;
  std::vector<geometry::Vec3> points;
  std::vector<mesh::CadDimension> dimension;  ///< per point: classification
  std::vector<std::int32_t> entity;           ///< per point: CAD entity
  std::vector<std::array<mesh::LocalIndex, 4>> tets;
  std::vector<CavityTriangle> triangles;  ///< of the surface mesh
};

/// A new vertex of a replaced cavity; inside the region by default.
struct AddedVertex {
  geometry::Vec3 point;
  mesh::CadDimension dimension = mesh::CadDimension::region;
  std::int32_t entity = 0;  ///< CAD entity of a vertex on the boundary
};

/// The replacement of a cavity. The new tetrahedra fill the same space and have the same boundary faces. Only
/// faces on the surface mesh may differ; `triangles` then lists the new ones.
struct CavityContent {
  std::vector<AddedVertex> added;  ///< numbered after the vertices of the cavity
  std::vector<std::array<mesh::LocalIndex, 4>> tets;
  std::optional<std::vector<CavityTriangle>> triangles;  ///< if present, replace those of the cavity

  const std::vector<CavityTriangle>& triangles_of(const Cavity& cavity) const {
    return triangles ? *triangles : cavity.triangles;
  }
};

/// Computes the replacement of a cavity, or nothing to keep it. The result must depend only on the argument.
using ReplaceCavity = std::function<std::optional<CavityContent>(const Cavity&)>;

/// Per local piece and vertex: the cavity that claims the star of the vertex, or no_cavity. If pieces claim a
/// shared vertex for different cavities, the highest number counts.
using CavityClaims = std::vector<std::vector<CavityId>>;

/// How a round changed a piece. Remaining cells keep their order; new cells follow them.
struct PieceChange {
  std::vector<mesh::LocalIndex> left;  ///< cells removed, by old number, ascending
  mesh::LocalIndex first_new = 0;      ///< index of the first new cell
};

struct CavityRound {
  std::int64_t cavities = 0, replaced = 0;  ///< of the whole mesh, equal on all ranks
  std::vector<PieceChange> changes;         ///< by local piece
};

/// `rings`: how many times a cavity grows by one layer of elements beyond the claimed stars. It grows only at
/// vertices inside a piece and next to no other cavity. `along_surface`: also at vertices on the surface.
struct CavityExtent {
  int rings = 1;
  bool along_surface = false;
};

/// What a round replaces, and how.
struct ReplacementRequest {
  const CavityClaims& claims;
  CavityExtent extent;
  const ReplaceCavity& replace;
};

/// Does one round. A cavity lies in one region. A claimed star is taken only if no neighbour of its vertex is
/// claimed by another cavity. So cavities share no tetrahedra; other claims wait for a later round. Cavities
/// are assigned to ranks by size. At most 255 rounds per mesh. `shared` must belong to the mesh as it comes
/// in. Collective. Throws CollectiveError.
CavityRound replace_cavities(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                             const ReplacementRequest& request);

}  // namespace aeroloom::cavities
