/// From surface pieces to volume pieces: the step that joins the surface and the volume stage, which know
/// nothing of each other.
///
/// Until volumes are decomposed there is one volume piece, on rank 0; its boundary is the whole surface. That
/// one rank holds the fine mesh is an exception to the project's second law, dated 2026-11-20; the interface
/// is the one that many pieces will use.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_mesher.hpp"

namespace aeroloom::pipeline {

/// The closed boundary of one volume piece with what its triangles and vertices stand for.
struct PieceBoundary {
  volume::ClosedSurface surface;
  std::vector<std::int8_t> vertex_dimension;  ///< per point
  std::vector<std::int32_t> vertex_entity;    ///< per point
  std::vector<std::int32_t> triangle_face;    ///< per triangle
  std::vector<std::int32_t> triangle_patch;   ///< per triangle
};

/// What the volume stage tells beyond its mesh.
struct VolumeReport {
  std::int64_t steiner_points = 0;
  int attempts = 1;
};

/// Collects the surface on the rank of the volume piece, in global order; empty elsewhere. Collective.
PieceBoundary gather_boundary(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              parallel::Rank owner);

/// Fills the volume pieces. Collective. Offending triangles of a failure are written to `offenders_file`.
mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator,
                                  const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                                  const sizing::SizeField& field, const volume::VolumeOptions& options,
                                  const std::string& offenders_file, parallel::StageClock& clock,
                                  VolumeReport& report);

}  // namespace aeroloom::pipeline
