/// The quality of a mesh of several cell shapes as JSON (docs/quality.md).
#pragma once

#include "mesh/quality/mixed_quality.hpp"

#include <nlohmann/json.hpp>

namespace aeroloom::report {

/// By shape and measure, with the worst cells of each measure. Shapes without cells are left out.
nlohmann::ordered_json to_json(const mesh::MixedQuality& quality);

}  // namespace aeroloom::report
