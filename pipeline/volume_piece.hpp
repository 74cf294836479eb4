/// From surface pieces to volume pieces: the step that joins the surface and the volume stage, which know
/// nothing of each other.
///
/// Until volumes are decomposed further, every region of the model (a solid of the CAD) is one volume piece.
/// Its boundary is never altered while it is filled, so regions that share CAD faces conform by construction.
/// That a rank holds the whole fine mesh of a region is an exception to the project's second law, dated
/// 2026-11-20; the interface is the one that many pieces will use.
#pragma once

#include "geometry/model.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_mesher.hpp"

namespace aeroloom::pipeline {

/// The closed boundary of one region with what its triangles and vertices stand for.
struct PieceBoundary {
  volume::ClosedSurface surface;
  std::vector<std::int8_t> vertex_dimension;     ///< per point
  std::vector<std::int32_t> vertex_entity;       ///< per point
  std::vector<mesh::GlobalIndex> vertex_number;  ///< per point: in the surface mesh, ascending
  std::vector<std::int32_t> triangle_face;       ///< per triangle
  std::vector<std::int32_t> triangle_patch;      ///< per triangle
};

/// What the volume stage tells beyond its mesh.
struct VolumeReport {
  std::int64_t steiner_points = 0;
  int attempts = 1;  ///< of the region that took most
};

/// The boundary of the domain: the surface without its inner faces, those between two regions. With `inner`,
/// those faces alone. Pieces keep their ids, left out ones are empty.
mesh::DistributedMesh part_of_surface(const mesh::DistributedMesh& surface, bool inner);

/// Collects the boundary of a region on one rank, in global order, triangles turned so that they are seen
/// counter-clockwise from outside the region; empty elsewhere. Collective.
PieceBoundary gather_boundary(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              geometry::RegionId region, parallel::Rank owner);

/// Fills the volume pieces, one per region, each on the rank that largest-first scheduling gives it. The
/// triangles of a face between two regions belong to the piece of its front region. Collective. Offending
/// triangles of a failure are written to `offenders_file`.
mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator, const geometry::Model& model,
                                  const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                                  const sizing::SizeField& field, const volume::VolumeOptions& options,
                                  const std::string& offenders_file, parallel::StageClock& clock,
                                  VolumeReport& report);

}  // namespace aeroloom::pipeline
