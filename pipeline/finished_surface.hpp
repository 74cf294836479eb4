/// A finished surface: its numbers, its sizes, checks and figures.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/report/run_record.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// The finished surface with its sizes, and the model that it is of.
struct FinishedSurface : mesh::NumberedMesh {
  sizing::SizeField field;
  surface::SurfaceReport report;
  cad::Model model;
  std::vector<mesh::PatchType> patch_types;  ///< by patch of the model
  sizing::SizingOptions sizes;               ///< that it was made for
  double forecast_tetrahedra = 0;            ///< by these sizes
  bool bounds_volume = true;  ///< false where layers end on planes: the volume has other triangles there
  report::SurfaceFigures figures = {};  ///< by inspect_surface()
};

/// Checks the surface and measures its quality, faces and patches. `what` names it in messages. Collective.
/// Throws as require_valid().
void inspect_surface(const std::string& what, FinishedSurface& surface);

/// Replaces the surface mesh by the boundary of a volume that was improved there. Collective. Throws as
/// inspect_surface().
void adopt_boundary(const mesh::DistributedMesh& volume, const mesh::Numbering& numbering,
                    FinishedSurface& surface);

}  // namespace aeroloom::pipeline
