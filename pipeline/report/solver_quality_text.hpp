/// What cell-centred solvers make of a mesh, as text.
#pragma once

#include "mesh/quality/solver_quality.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// Two sentences without an end, for the log: on faces, and on cells.
std::vector<std::string> solver_lines(const mesh::SolverQuality& quality);
/// A block of lines: these sentences, and a row for each class of inner faces.
std::string solver_text(const mesh::SolverQuality& quality);
/// The ten worst by each measure.
std::string worst_text(const mesh::SolverQuality& quality);

}  // namespace aeroloom::report
