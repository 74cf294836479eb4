/// The chart surface of a planar face within loops that need not be those of the CAD: a constrained Delaunay
/// triangulation of their vertices.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/face_loops.hpp"
#include "surface/division/piece_problem.hpp"

namespace aeroloom::surface {

/// The part of a plane that the loops enclose as one piece problem. Crossings are found exactly, in the
/// coordinates themselves. Throws FaceConflict where loops cross or touch, or enclose nothing;
/// std::invalid_argument where the face is no plane, or a vertex is not on an exact one
/// (Model::is_exact_plane).
PieceProblem problem_of_plane(const cad::Model& model, cad::FaceId face, const FaceLoops& loops,
                              const sizing::SizeField& field);

}  // namespace aeroloom::surface
