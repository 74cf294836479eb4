/// The quality of a mesh of several shapes for people to read.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/quality/mixed_quality.hpp"

#include <string>

namespace aeroloom::report {

/// Tables of counts by region and patch, of minima, percentiles and means by shape and measure, histograms
/// with bars, the worst cells by measure; lines of 120 characters at most, but for long names.
std::string quality_text(const io::FileMesh& mesh, const mesh::MixedQuality& quality);

}  // namespace aeroloom::report
