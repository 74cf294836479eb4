/// Numbering of a shape's entities and their evaluators. Seen by this folder only.
#pragma once

#include "cad/model/model_data.hpp"

namespace aeroloom::cad {

/// The evaluator of a face, without its edges; planar when it leaves a plane by no more than the tolerance.
FaceEvaluator make_evaluator(const TopoDS_Shape& shape, double planar_tolerance);

/// Fills vertices, edges, faces, evaluators and the regions' names (where absent) from data.shape. Ids follow
/// the order in which the shape's faces, their loops and their edges are stored. Throws CadError for faces
/// without solid, edges without curve and loops that do not close.
void index_topology(Model::Data& data);

}  // namespace aeroloom::cad
