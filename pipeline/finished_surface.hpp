/// The finished surface mesh, its checks and its figures.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/case/patch_rules.hpp"
#include "pipeline/report/run_record.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// The finished surface, its model and its sizes.
struct FinishedSurface : surface::SurfaceMesh {
  cad::Model model;
  std::vector<mesh::PatchType> types;  ///< by patch of the model
  sizing::SizingOptions sizes;         ///< used for the surface
  double forecast_tetrahedra = 0;      ///< predicted for the volume from these sizes
  bool bounds_volume = true;  ///< false if layers end on planes: the volume has other triangles there
  report::SurfaceFigures figures = {};  ///< results of inspect_surface()
};

/// The types of patches of a model that has some of those of the domain: a patch whose faces were all closed
/// is gone, and those after it have other numbers.
std::vector<mesh::PatchType> types_of(const std::vector<std::string>& patches,
                                      const cases::TypedPatches& domain);

/// Checks the surface and measures quality, faces and patches. `what` names the surface in messages.
/// Collective. Throws as require_valid().
void inspect_surface(const std::string& what, FinishedSurface& surface);

/// Looks for regions whose space falls into several parts, before they are filled. Where such are kept, warns
/// of them. Collective. Throws CollectiveError (input) with volumes and places where they are refused.
void judge_chambers(const mesh::NumberedMesh& surface, cases::ChamberUse chambers);

/// Replaces the surface mesh by the boundary of an improved volume and inspects it. Collective. Throws as
/// inspect_surface().
void adopt_boundary(const mesh::NumberedMesh& volume, FinishedSurface& surface);

}  // namespace aeroloom::pipeline
