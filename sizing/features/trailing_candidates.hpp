/// Trailing edges of a model: where a body ends against the flow.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"
#include "sizing/features/lifting_bodies.hpp"

#include <optional>
#include <vector>

namespace aeroloom::sizing {

/// A trailing edge, before it is known whether a lifting body lies ahead of it.
struct TrailingCandidate {
  LiftingElement element;               ///< stations, chords, leading edge and ends are not set
  std::vector<cad::FaceId> neighbours;  ///< faces on both sides
};

/// The face, if it is a blunt trailing edge that looks along the flow.
std::optional<TrailingCandidate> blunt_candidate(const cad::Model& model, cad::FaceId face,
                                                 geometry::Vec3 flow);

/// The edge, if two faces meet in it at less than 60 degrees and the body lies ahead.
std::optional<TrailingCandidate> sharp_candidate(const cad::Model& model, cad::EdgeId edge,
                                                 geometry::Vec3 flow);

}  // namespace aeroloom::sizing
