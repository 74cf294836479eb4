/// Vertices of tetrahedra on boundary layers.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// By piece of this rank and vertex: whether it is a corner of a layer cell of any piece. Collective.
std::vector<std::vector<std::uint8_t>> find_layer_vertices(const mesh::DistributedMesh& mesh);

}  // namespace aeroloom::attribution
