/// Blunt edges closed to sharp ones: virtual topology over an unchanged model.
///
/// A closed strip is no face any more. Its two long borders are one edge half-way between them, its short
/// ends are vertices; the faces across a short end lose it, and other edges that ended there are drawn to the
/// vertex. No surface changes: near the closed edge faces end up to half the strip's width beside their
/// edges.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// The model with these strips closed; their faces vanish, the others keep their order. serialise() gives the
/// closed model. Throws CadError naming the face where what is left would be no model: borders that
/// another strip closes, ends that become one vertex.
Model close_blunt_edges(const Model& model, const std::vector<BluntEdge>& strips);

}  // namespace aeroloom::cad
