/// The quality of a mesh of several cell shapes as text.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/solver_quality.hpp"

#include <string>

namespace aeroloom::report {

/// What cell-centred solvers make of the mesh; tables by region and patch; minima, percentiles and means by
/// shape and measure; histograms; worst cells. Lines have at most 120 characters, except for long names.
std::string quality_text(const io::FileMesh& mesh, const mesh::MixedQuality& quality,
                         const mesh::SolverQuality& solver);

}  // namespace aeroloom::report
