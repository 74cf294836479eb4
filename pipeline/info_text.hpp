/// Formats the facts about a file, as text and as JSON.
#pragma once

#include "cad/read/cad_facts.hpp"
#include "geometry/vec.hpp"
#include "io/doubled_nodes.hpp"
#include "io/raw_mesh.hpp"

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace aeroloom::pipeline {

/// Facts about a mesh file besides those of the mesh.
struct MeshFileFacts {
  std::string format;    ///< in words
  int parts = 0;         ///< 0: a format without parts
  geometry::Box bounds;  ///< of all points that cells use
  io::DoubledNodes doubled;
};

nlohmann::ordered_json doubled_nodes_json(const io::DoubledNodes& doubled);

nlohmann::ordered_json info_json(const io::Assembled& file, const MeshFileFacts& facts);
std::string info_text(const io::Assembled& file, const MeshFileFacts& facts);

nlohmann::ordered_json info_json(const cad::CadFacts& facts);
std::string info_text(const cad::CadFacts& facts);

}  // namespace aeroloom::pipeline
