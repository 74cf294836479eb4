/// The volume stage over all pieces: each part of the plan is filled by the rank that owns it.
#pragma once

#include "geometry/model.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/interface_angles.hpp"
#include "pipeline/interfaces.hpp"
#include "pipeline/piece_boundary.hpp"
#include "pipeline/volume_plan.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_mesher.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// Parts that became one because one of them could not be filled.
struct Merge {
  std::int32_t part, with;
  std::string reason;
};

/// What the volume stage tells beyond its mesh.
struct VolumeReport {
  std::int64_t steiner_points = 0;
  int attempts = 1;  ///< of the piece that took most
  std::vector<Merge> merges;
  InterfaceAngles angles;
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below
};

struct VolumeTask {
  const geometry::Model& model;
  const BoundaryMeshes& boundary;
  const VolumePlan& plan;
  const sizing::SizeField& field;
  const volume::VolumeOptions& options;
  std::string offenders_file;   ///< triangles of a failure are written there
  std::int64_t sabotaged = -1;  ///< the part that the options' sabotage strikes until it is merged; -1: all
};

/// Fills the parts, dealt out largest first. A part that no rung of the ladder fills is merged with its
/// neighbour across the offending interface; one without neighbours ends the run. Pieces are numbered by
/// their lowest part. The triangles of a face between two regions belong to pieces of its front region.
/// Collective. Throws CollectiveError.
mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator, const VolumeTask& task,
                                  parallel::StageClock& clock, VolumeReport& report);

}  // namespace aeroloom::pipeline
