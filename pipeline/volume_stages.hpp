/// The stages of a run from a finished surface to an improved volume.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/run.hpp"
#include "pipeline/stage_products.hpp"
#include "volume/volume_mesher.hpp"

#include <optional>

namespace aeroloom::pipeline {

/// What the stages of the volume begin with: zones to fill, or what an earlier run has made of them. One of
/// the three is there; the stage that takes it leaves it empty.
struct VolumeStart {
  std::optional<volume::Decomposition> zones = {};
  std::optional<io::CheckpointContent> filled = {}, improved = {};
};

/// Decomposition, filling and improvement of one run, in this order: each taken from the checkpoint of an
/// earlier run where there is one, else made and kept. All of it is collective.
class VolumeStages {
public:
  VolumeStages(const parallel::Communicator& communicator, const cases::Case& input,
               report::RunRecord& record, Checkpoints& checkpoints)
      : _communicator(communicator), _input(input), _record(record), _checkpoints(checkpoints) {}

  VolumeStart decompose(const sizing::SizedSurface& boundary);
  /// Nothing where an earlier run has the improved volume.
  VolumeProduct fill(const sizing::SizedSurface& boundary, VolumeStart& start);
  /// Improved, where the case asks for that.
  VolumeProduct improve(const cad::Model& model, const sizing::SizedSurface& boundary, VolumeStart& start,
                        VolumeProduct filled);

private:
  VolumeProduct adopt(io::CheckpointContent content, const char* stage);
  void keep(SavedStage saved, const VolumeProduct& product);
  volume::VolumeInput input_of(const sizing::SizedSurface& boundary);
  mesh::DistributedMesh fill_zones(const sizing::SizedSurface& boundary, volume::Decomposition zones,
                                   volume::VolumeReport& report);

  const parallel::Communicator& _communicator;
  const cases::Case& _input;
  report::RunRecord& _record;
  Checkpoints& _checkpoints;
};

}  // namespace aeroloom::pipeline
