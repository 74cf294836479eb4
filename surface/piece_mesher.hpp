/// Meshes one surface piece, and prepares a whole CAD face as a piece.
#pragma once

#include "mesh/data/piece.hpp"
#include "surface/curves/curves.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/rows/face_rows.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"

namespace aeroloom::surface {

/// The facets that the parametric triangulation of a face is built from. They turn by at most
/// options.facet_angle. Their distance from the surface is at most a small fraction of the model and of the
/// width of the face.
cad::Facets chart_facets(const cad::Model& model, cad::FaceId face, const SurfaceOptions& options);

/// A face whose rows are taken off.
struct FaceProblem {
  PieceProblem rest;  ///< of no use where rows failed
  FaceRows rows;
};

/// A whole face as one piece, and its rows. Throws SurfaceError or cad::CadError.
FaceProblem problem_of_face(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                            const sizing::SizeField& field, const SurfaceOptions& options);

/// The triangles of a piece, as a mesh piece with id 0. The result depends on the arguments alone, whatever
/// other pieces are meshed. Not collective. Throws FaceConflict, SurfaceError or cad::CadError.
mesh::Piece mesh_piece(const cad::Model& model, const PieceProblem& problem, const sizing::SizeField& field,
                       const SurfaceOptions& options);

}  // namespace aeroloom::surface
