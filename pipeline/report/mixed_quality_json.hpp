/// The quality of a mesh of several shapes as the project's JSON files have it (docs/quality.md).
#pragma once

#include "mesh/quality/mixed_quality.hpp"

#include <nlohmann/json.hpp>

namespace aeroloom::report {

/// By shape and measure, and the worst cells by measure; shapes that there are none of are left out.
nlohmann::ordered_json to_json(const mesh::MixedQuality& quality);

}  // namespace aeroloom::report
