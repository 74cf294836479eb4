/// Cavities that reach over several pieces: tetrahedra around chosen vertices are taken out, brought together
/// on one rank, replaced by others, and given back to the pieces. Pieces change their outline by this;
/// the mesh stays one mesh, whatever the rank count.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace aeroloom::cavities {

/// Cavities are named by numbers that follow from the mesh alone.
using CavityId = std::uint64_t;
inline constexpr CavityId no_cavity = 0;

/// A cavity per cell of a grid whose cells are `width` times as wide as `size`, up to eight times that: sizes
/// may grow a lot within a cell. Another `shift` gives a grid whose borders lie elsewhere.
CavityId cavity_at(geometry::Vec3 p, double size, double width, int shift);

/// A triangle of the surface mesh that bounds a cavity.
struct CavityTriangle {
  std::array<mesh::LocalIndex, 3> vertices;
  std::int32_t face, patch;
};

/// One cavity before it is replaced. Vertices are numbered within the cavity; those that pieces share come
/// by shared-vertex key, the others by piece, so the order is the same for any rank count.
struct Cavity {
  CavityId id = no_cavity;
  mesh::RegionId region = 0;
  std::vector<geometry::Vec3> points;
  std::vector<mesh::CadDimension> dimension;  ///< per point: classification
  std::vector<std::int32_t> entity;           ///< per point
  std::vector<std::array<mesh::LocalIndex, 4>> tets;
  std::vector<CavityTriangle> triangles;  ///< of the surface mesh, on the cavity's boundary
};

/// A vertex that comes with the new content; inside the region unless it says otherwise.
struct AddedVertex {
  geometry::Vec3 point;
  mesh::CadDimension dimension = mesh::CadDimension::region;
  std::int32_t entity = 0;  ///< of a vertex on the CAD
};

/// Tetrahedra that take the place of a cavity's. They cover the same region with the same boundary faces,
/// but for those on the surface mesh where `triangles` says so: the faces they leave open there.
struct CavityContent {
  std::vector<AddedVertex> added;  ///< numbered after those of the cavity
  std::vector<std::array<mesh::LocalIndex, 4>> tets;
  std::optional<std::vector<CavityTriangle>> triangles;  ///< in the place of the cavity's

  const std::vector<CavityTriangle>& triangles_of(const Cavity& cavity) const {
    return triangles ? *triangles : cavity.triangles;
  }
};

/// Refills a cavity; nothing: it stays as it was. Must be a function of its argument alone.
using ReplaceCavity = std::function<std::optional<CavityContent>(const Cavity&)>;

/// Per local piece, per vertex: the cavity that wants the star of this vertex; no_cavity for none. What one
/// piece claims a shared vertex, the others do too; where they differ the higher number counts.
using CavityClaims = std::vector<std::vector<CavityId>>;

/// The effect of a round on a piece: the cells that are left kept their order, and new ones stand after
/// them.
struct PieceChange {
  std::vector<mesh::LocalIndex> left;  ///< cells that went, ascending, as they were numbered before
  mesh::LocalIndex first_new = 0;      ///< the first cell that came
};

struct CavityRound {
  std::int64_t cavities = 0, replaced = 0;  ///< of the whole mesh, the same on every rank
  std::vector<PieceChange> changes;         ///< per local piece
};

/// How far cavities extend beyond the stars of claimed vertices: how often they take the stars of their
/// vertices too, where these lie inside a piece and near one cavity only; those on the surface where asked
/// for.
struct CavityExtent {
  int rings = 1;
  bool along_surface = false;
};

/// The cavities that a round takes out of the pieces, and how they are replaced.
struct ReplacementRequest {
  const CavityClaims& claims;
  CavityExtent extent;
  const ReplaceCavity& replace;
};

/// One round. A cavity lies in one region. A vertex's star is taken when no neighbour is claimed by another
/// cavity, so cavities do not touch in a tetrahedron; the others have to wait for another round with other
/// claims. Cavities are assigned to ranks by size. At most 255 rounds on one mesh. `shared` are those of the
/// mesh as it comes in. Collective. Throws CollectiveError.
CavityRound replace_cavities(mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                             const ReplacementRequest& request);

}  // namespace aeroloom::cavities
