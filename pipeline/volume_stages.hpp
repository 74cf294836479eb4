/// The stages from a finished surface to an improved volume.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/stage_products.hpp"
#include "volume/volume_mesher.hpp"

#include <optional>

namespace aeroloom::pipeline {

/// The start of the volume stages: zones to fill, or the result of an earlier run. One of the three is given;
/// the stage that uses it empties it.
struct VolumeStart {
  std::optional<volume::Decomposition> zones = {};
  std::optional<io::CheckpointContent> filled = {}, improved = {};
};

/// Decomposition, filling and improvement, in this order. Each takes its result from a checkpoint of an
/// earlier run, if there is one, else makes and keeps it. Collective.
class VolumeStages {
public:
  VolumeStages(const cases::Case& input, Checkpoints& checkpoints)
      : _input(input), _checkpoints(checkpoints) {}

  VolumeStart decompose(const sizing::SizedSurface& boundary);
  /// Empty if an earlier run has the improved volume. `tried`: receives the report if filling fails.
  VolumeProduct fill(const sizing::SizedSurface& boundary, VolumeStart& start, volume::VolumeReport& tried);
  /// Improves if the case asks for it.
  VolumeProduct improve(const cad::Model& model, const sizing::SizedSurface& boundary, VolumeStart& start,
                        VolumeProduct filled);

private:
  VolumeProduct adopt(const sizing::SizedSurface& boundary, io::CheckpointContent content);
  void keep(SavedStage saved, const VolumeProduct& product);
  volume::VolumeInput input_of(const sizing::SizedSurface& boundary);
  mesh::DistributedMesh fill_zones(const sizing::SizedSurface& boundary, volume::Decomposition zones,
                                   volume::VolumeReport& report);

  const cases::Case& _input;
  Checkpoints& _checkpoints;
};

}  // namespace aeroloom::pipeline
