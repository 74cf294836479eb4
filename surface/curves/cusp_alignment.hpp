/// Aligns the vertices of the two curves beside a closed cusp, so that they lie opposite each other.
#pragma once

#include "surface/curves/curves.hpp"

namespace aeroloom::surface {

/// The vertices of an edge from one of its ends up to the middle.
std::vector<CurveVertex> near_half(const cad::Model& model, const CurveMesh& curves, cad::EdgeEnd end);

/// Treats the corners that are closed (sizing/field/closed_corners.hpp), as far as their curves are nearer to
/// each other than `widest`. There the vertices of one curve move along it until they are as far from the CAD
/// vertex as those of the other curve. The next vertices move by decreasing steps. A corner stays as it is
/// where its curves are too short for that, or a vertex would pass the next one. The curve with the lower id
/// leads, unless the other one has followed a third curve before. The same on every rank.
void align_cusps(const cad::Model& model, double widest, CurveMesh& curves);

}  // namespace aeroloom::surface
