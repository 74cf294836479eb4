/// The stages of a run from a finished surface to an improved volume.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/run.hpp"

namespace aeroloom::pipeline {

/// The surface that a volume is filled within, with its sizes. Refers to what lives elsewhere.
struct VolumeBoundary {
  const mesh::NumberedMesh& surface;
  const sizing::SizeField& field;
};

/// Decomposition, filling and improvement of one run: each taken from the checkpoint of an earlier run where
/// there is one, else made and kept. All of it is collective.
class VolumeStages {
public:
  VolumeStages(const parallel::Communicator& communicator, const cases::Case& input,
               report::RunRecord& record, Checkpoints& checkpoints)
      : _communicator(communicator), _input(input), _record(record), _checkpoints(checkpoints) {}

  /// Improved, where the case asks for that.
  mesh::DistributedMesh find_or_build(const cad::Model& model, const VolumeBoundary& boundary);

private:
  mesh::DistributedMesh build(const VolumeBoundary& boundary);
  mesh::DistributedMesh adopt(io::CheckpointContent content);
  void keep(SavedStage saved, const mesh::DistributedMesh& volume);
  volume::VolumeInput input_of(const VolumeBoundary& boundary);
  volume::Decomposition decompose(const VolumeBoundary& boundary);
  mesh::DistributedMesh fill(const VolumeBoundary& boundary, volume::Decomposition decomposition);
  void improve(const cad::Model& model, const VolumeBoundary& boundary, mesh::DistributedMesh& volume);

  const parallel::Communicator& _communicator;
  const cases::Case& _input;
  report::RunRecord& _record;
  Checkpoints& _checkpoints;
};

}  // namespace aeroloom::pipeline
