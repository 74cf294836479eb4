/// How the CAD surface turns over its edges.
#pragma once

#include "cad/model/model.hpp"
#include "layers/columns.hpp"

#include <vector>

namespace aeroloom::pipeline {

/// By edge: sharp between two faces, or a face and itself, whose normals turn by layers::sharp_turn at one of
/// some places along it, or by half as much where it meets a sharp edge; smooth if they do not. Others, and
/// edges of faceted faces, are unknown: facets are what turns there. Between a face of `planes` and another
/// it is the other's turn into its mirror image that counts, and those that are not sharp are upright.
std::vector<layers::EdgeTurn> find_edge_turns(const cad::Model& model,
                                              const std::vector<cad::FaceId>& planes = {});

/// By edge: the largest angle in radians by which the walls turn over it at one of some places, where it is
/// sharp and convex seen from the fluid; else 0. Between a face of `planes` and another it is the half of the
/// turn into the mirror image that lies on this side: what half a fan divides.
std::vector<double> find_ridge_turns(const cad::Model& model, const std::vector<cad::FaceId>& planes = {});

}  // namespace aeroloom::pipeline
