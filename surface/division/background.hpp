/// The background mesh of a piece that is to be divided: a mesh of the same surface with several times the
/// size. It is partitioned in place of the fine mesh. The piece may be a whole CAD face or a part of one.
#pragma once

#include "surface/division/coarse_loops.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/remesh/remesh.hpp"
#include "surface/surface_options.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

/// Triangles on the CAD surface. Their vertices on the loops are a subset of the fine vertices there.
struct Background {
  FaceMesh mesh;                       ///< its first `mesh.fixed` vertices lie on the loops
  std::vector<std::int32_t> on_loops;  ///< for each of those: the vertex of the piece problem
  CoarseLoops loops;
};

/// Meshes the piece under `coarse` sizes, `factor` times the fine ones. An edge turns by at most 30 degrees.
/// Nothing where its loops cross at such sizes or no chart can be found. Not collective. Throws
/// cad::CadError.
std::optional<Background> mesh_background(const cad::Model& model, const PieceProblem& problem,
                                          const sizing::SizeField& coarse, double factor,
                                          const SurfaceOptions& options);

/// The background as a parametric triangulation. It has the fine vertices on its loops, numbered as in the
/// problem, and is refined until it follows the surface. `part` per triangle is updated.
ChartSurface chart_surface_of(const cad::Model& model, const PieceProblem& problem,
                              const Background& background, std::vector<std::int32_t>& part);

}  // namespace aeroloom::surface
