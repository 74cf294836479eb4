/// The surface stage: meshes CAD curves and faces to a closed, conforming, oriented triangulation.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"

namespace aeroloom::parallel {
class TaskStore;
}

namespace aeroloom::surface {

struct SurfaceMesh {
  mesh::DistributedMesh
      mesh;  ///< triangle pieces, each part of one CAD face, numbered by face; spread over ranks by load
  SurfaceReport report;
  /// The size field with the sources that were added where surfaces came too close. The volume is filled
  /// under it.
  sizing::SizeField field;
};

/// Meshes the surface of the model on the ranks of the field. Pieces found in `tasks` are not meshed again,
/// new ones are kept there. The context of `tasks` must identify the model and the options. Collective.
/// Throws SurfaceError or CollectiveError, the same on all ranks.
SurfaceMesh mesh_surface(const cad::Model& model, const sizing::SizeField& field,
                         const SurfaceOptions& options, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
