/// Finds nodes of a mesh that lie at the places of others, as on interfaces that are not connected.
#pragma once

#include "geometry/vec.hpp"
#include "io/file_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Boundary nodes with exactly equal coordinates.
struct DoubledNodes {
  std::int64_t nodes = 0;            ///< that lie where another one with a lower number lies
  std::int64_t faces = 0;            ///< boundary faces that lie where another one lies, with other nodes
  geometry::Vec3 place;              ///< of the first, by x, y, z
  std::vector<std::string> regions;  ///< that have nodes there
  std::vector<std::string> patches;  ///< of these faces
};

/// Looks at the nodes of all faces, also of those between regions. The same on all ranks, and on any number
/// of them. Collective.
DoubledNodes find_doubled_nodes(const FileMesh& mesh);

/// What it means, in one or two sentences that begin with a number and end without a stop. Needs nodes.
std::string describe(const DoubledNodes& doubled);

}  // namespace aeroloom::io
