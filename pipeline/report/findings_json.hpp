/// Findings of the sizing stage as JSON, for report.json and check.json.
#pragma once

#include "pipeline/domain/bounded_faces.hpp"
#include "pipeline/domain/trailing_edges.hpp"
#include "pipeline/domain/unresolved_features.hpp"
#include "pipeline/domain/wall_findings.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::report {

nlohmann::ordered_json to_json(const std::vector<domain::NamedBound>& faces);
nlohmann::ordered_json to_json(const domain::TrailingEdgeReport& edges);
nlohmann::ordered_json to_json(const domain::FeatureReport& features);
nlohmann::ordered_json to_json(const domain::WallFindings& walls);

}  // namespace aeroloom::report
