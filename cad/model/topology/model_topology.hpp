/// Numbers the entities of a shape and makes their evaluators. Internal to cad/.
#pragma once

#include "cad/model/model_data.hpp"

namespace aeroloom::cad {

/// The evaluator of a face without its edges. The face is planar if it leaves a plane by at most the
/// tolerance.
FaceEvaluator make_evaluator(const TopoDS_Shape& shape, double planar_tolerance);

/// Fills vertices, edges, faces, evaluators and missing region names from data.shape. Ids follow the order in
/// which faces, loops and edges are stored. Throws CadError for faces without solid, edges without curve and
/// loops that are not closed.
void index_topology(Model::Data& data);

}  // namespace aeroloom::cad
