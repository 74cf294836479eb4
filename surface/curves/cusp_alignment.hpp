/// Vertices on two curves that a closed corner lies between, opposite each other.
#pragma once

#include "surface/curves/curves.hpp"

namespace aeroloom::surface {

/// The vertices of an edge from one of its ends up to the middle.
std::vector<CurveVertex> near_half(const cad::Model& model, const CurveMesh& curves, cad::EdgeEnd end);

/// Beside corners that are closed (sizing/field/closed_corners.hpp) as far as the curves are apart by less
/// than `widest`, the vertices of one curve move along it until they are as far from the CAD vertex as those
/// of the other; after that, they go back to their own places step by step. A corner stays as it is where its
/// curves end too early for that. Of two curves the one with the lower id leads, unless the other one
/// followed a third before. The same on every rank.
void align_cusps(const cad::Model& model, double widest, CurveMesh& curves);

}  // namespace aeroloom::surface
