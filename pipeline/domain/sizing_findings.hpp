/// Findings of the sizing stage besides the sizes. Report, checkpoint and `aeroloom check` contain them.
#pragma once

#include "cad/model/model.hpp"
#include "cad/repair/change.hpp"
#include "pipeline/domain/bounded_faces.hpp"
#include "pipeline/domain/trailing_edges.hpp"
#include "pipeline/domain/unresolved_features.hpp"
#include "pipeline/domain/wall_findings.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::domain {

/// Narrow faces that were joined with neighbours.
struct JoinedFaces {
  std::vector<std::vector<cad::FaceId>> groups;  ///< argument of cad::join_faces()
  cad::Changes changes;                          ///< one for each face that was joined
};

/// Equal on every rank. Checkpoints have the fields in this order.
struct SizingFindings {
  JoinedFaces joined;
  sizing::PredictedCounts counts;              ///< predicted from the size field
  std::optional<FeatureReport> features = {};  ///< if sizes of features were chosen
  std::vector<NamedBound> bounded =
      {};                          ///< faces where the smallest size prevents the wanted curvature angle
  TrailingEdgeReport edges = {};   ///< blunt trailing edges, if they were examined
  WallFindings walls = {};         ///< walls close to each other
  std::string far_field = {};      ///< which faces are far field, and why
  std::string missed_target = {};  ///< a sentence, where the target is missed by far
};

}  // namespace aeroloom::domain
