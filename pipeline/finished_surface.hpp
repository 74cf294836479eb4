/// A finished surface: its numbers, its sizes, checks and figures.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/run.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// The finished surface and the model that it is of.
struct FinishedSurface : surface::SurfaceMesh {
  cad::Model model;
  std::vector<mesh::PatchType> patch_types;  ///< by patch of the model
  bool bounds_volume = true;  ///< false where layers end on planes: the volume has other triangles there
};

/// Checks the surface and puts its quality and the table of patches on record. Collective. Throws as
/// require_valid().
void inspect_surface(const std::string& what, const FinishedSurface& surface, report::RunRecord& record);

/// The surface follows a volume whose boundary was improved. Collective.
void adopt_boundary(const mesh::NumberedMesh& volume, FinishedSurface& surface, report::RunRecord& record);

}  // namespace aeroloom::pipeline
