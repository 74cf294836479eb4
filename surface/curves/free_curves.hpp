/// Curves between faces that are all remeshed. No other face has their vertices, so these may follow when the
/// ends of the curve have moved.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/face_loops.hpp"

#include <span>

namespace aeroloom::surface {

/// Places the vertices of free curves of a face anew: curves that no face outside `faces` (ascending) has,
/// and with an end that is no longer at its CAD vertex. An example is the line in which two planes meet, when
/// boundary layers have moved its end. The curve moves with its ends, in proportion between them. It keeps
/// its number of vertices, placed in the metric of the field. The result does not depend on where its
/// vertices were, so it is the same for all faces that have the curve.
void spread_on_free_curves(const cad::Model& model, const sizing::SizeField& field, cad::FaceId face,
                           std::span<const cad::FaceId> faces, FaceLoops& loops);

}  // namespace aeroloom::surface
