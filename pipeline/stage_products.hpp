/// Results of stages as the content of checkpoints, and back. Unpacking with a communicator is collective.
/// Drafts refer to the meshes they are of. Bytes that are none of ours throw std::logic_error (checkpoints
/// are checked before).
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/improve_report.hpp"
#include "io/checkpoint_file.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "surface/surface_mesher.hpp"
#include "volume/volume_report.hpp"

#include <optional>

namespace aeroloom::pipeline {

io::CheckpointDraft pack_domain_product(const cad::Domain& domain);
cad::Domain unpack_domain_product(io::CheckpointContent content);

/// The model is that of the domain with its faces joined: it is made again.
io::CheckpointDraft pack_sizes(const domain::SizedDomain& sized);
domain::SizedDomain unpack_sizes(const parallel::Communicator& communicator, io::CheckpointContent content,
                                 const cad::Model& domain);

/// A surface with the model that it was made of, and its sizes.
struct SurfaceProduct {
  const surface::SurfaceMesh& surface;  ///< its field is left out where it is the one of the sized domain
  const domain::SizedDomain& sized;
  bool sizes_are_other;  ///< than those of the stage before: they come along
};
io::CheckpointDraft pack_surface(const parallel::Communicator& communicator, const SurfaceProduct& product);
/// `sized` becomes what the surface is of, where that came along. Nothing where it is the surface of other
/// sizes or of other joined faces.
std::optional<surface::SurfaceMesh> unpack_surface(const parallel::Communicator& communicator,
                                                   io::CheckpointContent content, const cad::Model& domain,
                                                   domain::SizedDomain& sized);

/// A volume with what its stages tell.
struct VolumeProduct {
  mesh::DistributedMesh mesh;
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  improve::ImproveReport improve;  ///< as it is before improvement
};
io::CheckpointDraft pack_volume(const VolumeProduct& product);
VolumeProduct unpack_volume(const parallel::Communicator& communicator, io::CheckpointContent content);

}  // namespace aeroloom::pipeline
