/// A CAD face as a piece: its support, and what meshing a piece makes of it.
#pragma once

#include "mesh/piece.hpp"
#include "surface/curves.hpp"
#include "surface/piece_seed.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_options.hpp"

namespace aeroloom::surface {

/// The facets a face's support is made of: they turn by at most options.support_angle and leave the surface
/// by a small part of the model and of the face's width.
cad::Facets support_facets(const cad::Model& model, cad::FaceId face, const SurfaceOptions& options);

/// A whole face as one piece. Throws SurfaceError or cad::CadError.
PieceSeed seed_of_face(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                       const sizing::SizeField& field, const SurfaceOptions& options);

/// The triangle piece of a seed, id 0. A function of the arguments alone: the same bits alone or in a run
/// with others. Not collective. Throws FaceConflict, SurfaceError or cad::CadError.
mesh::Piece mesh_piece(const cad::Model& model, const PieceSeed& seed, const sizing::SizeField& field,
                       const SurfaceOptions& options);

}  // namespace aeroloom::surface
