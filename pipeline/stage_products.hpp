/// Packs results of stages into checkpoints and unpacks them. Unpacking of sizes, surface and volume is
/// collective. Drafts refer to the packed meshes. Invalid bytes throw std::logic_error; checkpoints are
/// verified before.
#pragma once

#include "improve/improve_report.hpp"
#include "io/checkpoint_file.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "surface/surface_mesher.hpp"
#include "volume/volume_report.hpp"

#include <optional>

namespace aeroloom::pipeline {

/// The model is not packed: unpack_sizes() derives it from the domain.
io::CheckpointDraft pack_sizes(const domain::SizedDomain& sized);
domain::SizedDomain unpack_sizes(const parallel::Communicator& communicator, io::CheckpointContent content,
                                 const cad::Model& domain);

/// A surface and the sized domain that it was made from.
struct SurfaceProduct {
  const surface::SurfaceMesh& surface;  ///< its field is packed only if it is not that of `sized`
  const domain::SizedDomain& sized;
  bool sizes_are_other;  ///< from those of the sizing stage: the sizes are packed, too
};
io::CheckpointDraft pack_surface(const SurfaceProduct& product);
/// If sizes were packed, `sized` is replaced by them. Empty if the surface belongs to other sizes or joined
/// faces.
std::optional<surface::SurfaceMesh> unpack_surface(io::CheckpointContent content, const cad::Model& domain,
                                                   domain::SizedDomain& sized);

/// A volume and the reports of its stages.
struct VolumeProduct {
  mesh::DistributedMesh mesh;
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  improve::ImproveReport improve;  ///< empty before improvement
};
io::CheckpointDraft pack_volume(const VolumeProduct& product);
VolumeProduct unpack_volume(const parallel::Communicator& communicator, io::CheckpointContent content);

}  // namespace aeroloom::pipeline
