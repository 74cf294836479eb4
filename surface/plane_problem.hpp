/// The piece problem of a planar face with given loops, which may differ from those of the CAD.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/face_loops.hpp"
#include "surface/division/piece_problem.hpp"

namespace aeroloom::surface {

/// The region of the plane inside the loops, triangulated from their vertices alone (constrained Delaunay).
/// Crossings are found exactly, from the coordinates. Throws FaceConflict where loops cross or touch, or
/// enclose nothing. Throws std::invalid_argument where the face is no plane, or a vertex is off an exact one
/// (Model::is_exact_plane).
PieceProblem problem_of_plane(const cad::Model& model, cad::FaceId face, const FaceLoops& loops,
                              const sizing::SizeField& field);

}  // namespace aeroloom::surface
