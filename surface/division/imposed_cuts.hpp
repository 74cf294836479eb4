/// The surface stage under cuts that somebody else asks for, which is how tests look at cuts of any shape.
/// Internal to surface/: others call mesh_surface() under SurfaceOptions.
#pragma once

#include "surface/division/background_surface.hpp"
#include "surface/surface_mesher.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::surface {

/// Divides the background mesh of a face: the part of each of its triangles, from 0. The borders between
/// parts become cuts. Must be a function of its arguments alone.
using FaceDivider =
    std::function<std::vector<std::int32_t>(cad::FaceId, const partition::BackgroundSurface&)>;

/// What the steps of the stage go by.
struct CutOptions : SurfaceOptions {
  FaceDivider divider = {};  ///< cuts every face; empty: faces are cut by load
};

/// As mesh_surface().
SurfaceMesh mesh_surface_with_cuts(const cad::Model& model, const sizing::SizeField& field,
                                   const CutOptions& options, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::surface
