/// The background mesh of a CAD face: the same surface under sizes several times as large, from which its
/// pieces are cut.
#pragma once

#include "surface/coarse_curves.hpp"
#include "surface/remesh.hpp"
#include "surface/support.hpp"
#include "surface/surface_mesher.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

/// Triangles on the CAD surface. Their vertices on CAD curves are a subset of the fine ones.
struct FaceBackground {
  FaceMesh mesh;                       ///< its first `mesh.fixed` vertices lie on CAD curves
  std::vector<CurveVertex> on_curves;  ///< for those: the fine curve vertex
  CoarseCurves curves;
};

/// Meshes the face under `coarse`, sizes `factor` times those of the fine mesh; an edge turns by at most 30
/// degrees. Nothing where the face has no such mesh: its curves cross when they are as coarse as that. Not
/// collective. Throws SurfaceError or geometry::CadError.
std::optional<FaceBackground> mesh_background(const geometry::Model& model, geometry::FaceId face,
                                              const CurveMesh& curves, const geometry::Facets& facets,
                                              const sizing::SizeField& coarse, double factor,
                                              const SurfaceOptions& options);

/// The background as a support: parameters at triangle corners, fine vertices on the CAD curves, and facets
/// that follow the surface. `part` per triangle is kept up; `vertices` receives the vertices on the curves.
Support support_of(const geometry::Model& model, const FaceBackground& background, const CurveMesh& curves,
                   std::vector<std::int32_t>& part, FaceVertices& vertices);

}  // namespace aeroloom::surface
