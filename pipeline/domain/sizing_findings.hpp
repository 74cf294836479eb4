/// Findings of the sizing stage, besides the sizes: what a run, its report, its checkpoint and `check` tell.
#pragma once

#include "cad/model/model.hpp"
#include "cad/repair/change.hpp"
#include "pipeline/domain/bounded_faces.hpp"
#include "pipeline/domain/trailing_edges.hpp"
#include "pipeline/domain/unresolved_features.hpp"
#include "pipeline/domain/wall_findings.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>
#include <tuple>
#include <vector>

namespace aeroloom::domain {

/// Narrow faces that were joined with neighbours.
struct JoinedFaces {
  std::vector<std::vector<cad::FaceId>> groups;  ///< for cad::join_faces
  cad::Changes changes;                          ///< one for each face that vanished

  static constexpr auto fields() { return std::tuple(&JoinedFaces::groups, &JoinedFaces::changes); }
};

/// The same on every rank. A checkpoint of sizes has the fields in this order.
struct SizingFindings {
  JoinedFaces joined;
  sizing::PredictedCounts counts;              ///< that the size field predicts
  std::optional<FeatureReport> features = {};  ///< where sizes at features were chosen
  std::vector<NamedBound> bounded = {};        ///< faces on which the smallest size wins over curvature
  TrailingEdgeReport edges = {};  ///< what becomes of blunt trailing edges, where that was looked at
  WallFindings walls = {};        ///< what was found of walls close to each other

  static constexpr auto fields() {
    return std::tuple(&SizingFindings::joined, &SizingFindings::counts, &SizingFindings::features,
                      &SizingFindings::bounded, &SizingFindings::edges, &SizingFindings::walls);
  }
};

}  // namespace aeroloom::domain
