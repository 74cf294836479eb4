#include "improve/attribution/front_vertices.hpp"

#include "mesh/exchange/shared_vertices.hpp"

#include <algorithm>
#include <cstddef>

namespace aeroloom::attribution {

std::vector<std::vector<std::uint8_t>> find_front_vertices(const mesh::DistributedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::vector<std::vector<std::uint8_t>> on_front;
  bool layered = false;
  for (const mesh::Piece& piece : mesh.pieces) {
    std::vector<std::uint8_t>& flags = on_front.emplace_back(piece.vertex_count(), 0);
    // Cells of layers have pieces of their own.
    const bool of_layers =
        std::any_of(piece.layers.begin(), piece.layers.end(), [](auto k) { return k > 0; });
    if (of_layers) std::fill(flags.begin(), flags.end(), 1);
    layered = layered || of_layers;
  }
  if (communicator.maximum(std::int64_t{layered}) == 0) return on_front;
  const mesh::SharedVertices shared(mesh);
  std::vector<std::uint8_t> copies(shared.size());
  shared.for_each(
      [&](std::size_t p, mesh::LocalIndex v, std::size_t copy) { copies[copy] = on_front[p][v]; });
  shared.reduce_and_scatter(copies, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  shared.for_each(
      [&](std::size_t p, mesh::LocalIndex v, std::size_t copy) { on_front[p][v] = copies[copy]; });
  return on_front;
}

}  // namespace aeroloom::attribution
