/// Facts about files, for people and for programs.
#pragma once

#include "cad/read/cad_facts.hpp"
#include "geometry/vec.hpp"
#include "io/raw_mesh.hpp"

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace aeroloom::pipeline {

/// A mesh as it was read, with what its parts do not tell.
struct MeshFileFacts {
  std::string format;    ///< in words
  int parts = 0;         ///< of the file; 0: a format of one part
  geometry::Box bounds;  ///< of the points that cells use
};

nlohmann::ordered_json info_json(const io::Assembled& file, const MeshFileFacts& facts);
std::string info_text(const io::Assembled& file, const MeshFileFacts& facts);

nlohmann::ordered_json info_json(const cad::CadFacts& facts);
std::string info_text(const cad::CadFacts& facts);

}  // namespace aeroloom::pipeline
