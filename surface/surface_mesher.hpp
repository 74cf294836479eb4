/// The surface stage: from CAD curves and faces to a closed, conforming, oriented triangulation.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "sizing/field/sized_surface.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"

namespace aeroloom::parallel {
class TaskStore;
}

namespace aeroloom::surface {

/// Triangle pieces, each part of one CAD face, numbered by face and spread over ranks by load. The field has
/// the sources that rounds of local refinement added.
struct SurfaceMesh : sizing::SizedSurface {
  SurfaceReport report;
};

/// Meshes the surface of the model. Collective. Throws SurfaceError or CollectiveError, the same on all
/// ranks. Pieces found in `tasks`, whose context stands for the model and the options, are not meshed again;
/// those meshed are kept there.
SurfaceMesh mesh_surface(const parallel::Communicator& communicator, const cad::Model& model,
                         const sizing::SizeField& field, const SurfaceOptions& options,
                         parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
