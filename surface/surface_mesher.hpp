/// The surface stage: from CAD curves and faces to a closed, conforming, oriented triangulation.
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
  /// The field with the sources that mending added; the volume follows this one.
  sizing::SizeField field;
};

/// Meshes the surface of the model on the ranks of the field. Collective. Throws SurfaceError or
/// CollectiveError, the same on all ranks. Pieces found in `tasks`, whose context stands for the model and
/// the options, are not meshed again; those meshed are kept there.
SurfaceMesh mesh_surface(const cad::Model& model, const sizing::SizeField& field,
                         const SurfaceOptions& options, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
