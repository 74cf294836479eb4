/// The surface stage with cuts that the caller prescribes. Tests use it to study cuts of any shape. Internal
/// to surface/: others call mesh_surface() with SurfaceOptions.
#pragma once

#include "surface/division/background_surface.hpp"
#include "surface/surface_mesher.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::surface {

/// Divides the background mesh of a face: returns the part of each triangle, from 0. The borders between
/// parts become cuts. Must be a function of its arguments alone.
using FaceDivider =
    std::function<std::vector<std::int32_t>(cad::FaceId, const partition::BackgroundSurface&)>;

/// Options of the surface stage, with a divider.
struct CutOptions : SurfaceOptions {
  FaceDivider divider = {};  ///< divides every face; empty: faces are divided by load
};

/// As mesh_surface().
SurfaceMesh mesh_surface_with_cuts(const cad::Model& model, const sizing::SizeField& field,
                                   const CutOptions& options, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
