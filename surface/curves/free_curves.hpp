/// Curves between faces that are all meshed again: nobody else knows their vertices, so these follow where
/// the ends went.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/face_loops.hpp"

#include <span>

namespace aeroloom::surface {

/// Spreads the vertices of a face's curves anew where no other faces than these (ascending) have the curve
/// and one of its ends is no longer where the CAD vertex is: a column of layers, say, went along the line in
/// which two planes meet. The curve moves with its ends, in proportion between them; as many vertices as it
/// had are spread over it in the metric of the field. The same for all faces that share the curve, however
/// its vertices lay before.
void spread_on_free_curves(const cad::Model& model, const sizing::SizeField& field, cad::FaceId face,
                           std::span<const cad::FaceId> faces, FaceLoops& loops);

}  // namespace aeroloom::surface
