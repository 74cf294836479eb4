#include "improve/attribution/layer_vertices.hpp"

#include "mesh/exchange/shared_vertices.hpp"

#include <algorithm>

namespace aeroloom::attribution {

std::vector<std::vector<std::uint8_t>> find_layer_vertices(const mesh::DistributedMesh& mesh) {
  std::vector<std::vector<std::uint8_t>> on_layers;
  bool layered = false;
  for (const mesh::Piece& piece : mesh.pieces) {
    std::vector<std::uint8_t>& flags = on_layers.emplace_back(piece.vertex_count(), 0);
    // Cells of layers have pieces of their own.
    const bool of_layers =
        std::any_of(piece.layers.begin(), piece.layers.end(), [](auto k) { return k > 0; });
    if (of_layers) std::fill(flags.begin(), flags.end(), 1);
    layered = layered || of_layers;
  }
  if (mesh.communicator.maximum(std::int64_t{layered}) == 0) return on_layers;
  mesh::SharedVertices(mesh).combine(on_layers,
                                     [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  return on_layers;
}

}  // namespace aeroloom::attribution
