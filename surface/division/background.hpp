/// The background mesh of a piece that is to be divided: the same surface under sizes several times as large,
/// from which smaller pieces are cut. A whole CAD face is such a piece, and so is a part of one.
#pragma once

#include "surface/division/coarse_loops.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/remesh/remesh.hpp"
#include "surface/surface_options.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

/// Triangles on the CAD surface. Their vertices on the loops of the piece are a subset of the fine ones.
struct Background {
  FaceMesh mesh;                       ///< its first `mesh.fixed` vertices lie on the loops
  std::vector<std::int32_t> on_loops;  ///< for those: the vertex of the piece problem
  CoarseLoops loops;
};

/// Meshes the piece under `coarse` sizes, `factor` times the fine ones; an edge turns by at most 30 degrees.
/// Nothing where it has no such mesh: its loops cross, or no chart holds it, when they are as coarse as that.
/// Not collective. Throws cad::CadError.
std::optional<Background> mesh_background(const cad::Model& model, const PieceProblem& problem,
                                          const sizing::SizeField& coarse, double factor,
                                          const SurfaceOptions& options);

/// The background as a chart surface: parameters at triangle corners, the fine vertices on its loops
/// (numbered as those of the piece problem), and facets that follow the surface. `part` per triangle is kept
/// up.
ChartSurface chart_surface_of(const cad::Model& model, const PieceProblem& problem,
                              const Background& background, std::vector<std::int32_t>& part);

}  // namespace aeroloom::surface
