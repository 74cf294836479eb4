/// The quality of a mesh from a file.
#pragma once

#include "io/read_mesh.hpp"
#include "pipeline/case/quality_gate.hpp"

#include <string>

namespace aeroloom::pipeline {

struct QualityRequest {
  std::string file;         ///< the mesh
  bool print_json = false;  ///< instead of text
  std::string json_file;    ///< written where not empty
};

/// Measures the mesh of a file (mesh/quality/mixed_quality.hpp), prints the result, and writes it where asked
/// for. Returns the limits of the gate that the mesh misses, the same on every rank; empty: none. Collective.
/// Throws CollectiveError.
std::string show_quality(const io::Assembled& file, const QualityRequest& request,
                         const cases::QualityGate& gate);

}  // namespace aeroloom::pipeline
