/// The surface stage: meshes CAD curves and faces to a closed, conforming, oriented triangulation.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/sized_surface.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"

#include <vector>

namespace aeroloom::parallel {
class TaskStore;
}

namespace aeroloom::surface {

/// Triangle pieces, each part of one CAD face, numbered by face and spread over ranks by load. The field has
/// the sources that rounds of local refinement added.
struct SurfaceMesh : sizing::SizedSurface {
  SurfaceReport report;
  std::vector<sizing::SizeSource> lowered = {};  ///< those sources, the same on every rank
};

/// Meshes the surface of the model on the ranks of the field. Pieces found in `tasks` are not meshed again,
/// new ones are kept there. The context of `tasks` must identify the model and the options. Collective.
/// Throws SurfaceError or CollectiveError, the same on all ranks.
SurfaceMesh mesh_surface(const cad::Model& model, const sizing::SizeField& field,
                         const SurfaceOptions& options, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
