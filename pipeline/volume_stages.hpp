/// The stages of a run from a finished surface to an improved volume.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/stage_products.hpp"
#include "volume/volume_mesher.hpp"

#include <optional>

namespace aeroloom::pipeline {

/// The surface that a volume is filled within, with its sizes. Refers to what lives elsewhere.
struct VolumeBoundary {
  const mesh::NumberedMesh& surface;
  const sizing::SizeField& field;
};

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
  VolumeStages(const cases::Case& input, Checkpoints& checkpoints)
      : _input(input), _checkpoints(checkpoints) {}

  VolumeStart decompose(const VolumeBoundary& boundary);
  /// Nothing where an earlier run has the improved volume. `tried` gets the report of a filling that fails.
  VolumeProduct fill(const VolumeBoundary& boundary, VolumeStart& start, volume::VolumeReport& tried);
  /// Improved, where the case asks for that.
  VolumeProduct improve(const cad::Model& model, const VolumeBoundary& boundary, VolumeStart& start,
                        VolumeProduct filled);

private:
  VolumeProduct adopt(const VolumeBoundary& boundary, io::CheckpointContent content);
  void keep(SavedStage saved, const VolumeProduct& product);
  volume::VolumeInput input_of(const VolumeBoundary& boundary);
  mesh::DistributedMesh fill_zones(const VolumeBoundary& boundary, volume::Decomposition zones,
                                   volume::VolumeReport& report);

  const cases::Case& _input;
  Checkpoints& _checkpoints;
};

}  // namespace aeroloom::pipeline
