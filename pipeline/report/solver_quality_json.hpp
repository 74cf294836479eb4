/// What cell-centred solvers make of a mesh, as JSON (docs/quality.md).
#pragma once

#include "mesh/quality/solver_quality.hpp"

#include <nlohmann/json.hpp>

namespace aeroloom::report {

nlohmann::ordered_json to_json(const mesh::SolverQuality& quality);

}  // namespace aeroloom::report
