/// A CAD face as a piece: its chart surface, and what meshing a piece makes of it.
#pragma once

#include "mesh/data/piece.hpp"
#include "surface/curves/curves.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"

namespace aeroloom::surface {

/// The facets a face's chart surface is made of: they turn by at most options.facet_angle and leave the
/// surface by a small fraction of the model and of the face's width.
cad::Facets chart_facets(const cad::Model& model, cad::FaceId face, const SurfaceOptions& options);

/// A whole face as one piece. Throws SurfaceError or cad::CadError.
PieceProblem problem_of_face(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                             const sizing::SizeField& field, const SurfaceOptions& options);

/// The triangle piece of a piece problem, id 0. A function of the arguments alone: the same bits alone or in
/// a run with others. Not collective. Throws FaceConflict, SurfaceError or cad::CadError.
mesh::Piece mesh_piece(const cad::Model& model, const PieceProblem& problem, const sizing::SizeField& field,
                       const SurfaceOptions& options);

}  // namespace aeroloom::surface
