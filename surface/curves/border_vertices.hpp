/// How vertices on the borders of surface pieces are classified on the CAD.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/piece.hpp"

namespace aeroloom::surface {

/// Appends what a vertex on a border of a piece of a face lies on, by its key: a CAD vertex, an edge, or the
/// face itself.
void classify_border_vertex(cad::FaceId face, mesh::SharedVertexKey vertex_key, mesh::Piece& piece);

}  // namespace aeroloom::surface
