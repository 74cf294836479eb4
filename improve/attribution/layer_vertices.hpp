/// Which vertices of tetrahedra lie on boundary layers.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// For each piece of this rank and each of its vertices: whether it is a corner of a cell of layers, of any
/// piece. Collective.
std::vector<std::vector<std::uint8_t>> find_layer_vertices(const mesh::DistributedMesh& mesh);

}  // namespace aeroloom::attribution
