#include "pipeline/size_conformity.hpp"

#include <algorithm>

namespace aeroloom::pipeline {

SizeConformity measure_conformity(const parallel::Communicator& communicator,
                                  const mesh::DistributedMesh& mesh, const sizing::SizeField& field) {
  constexpr double shortest = 0.7, longest = 1.4;
  std::int64_t edges = 0, good = 0, bytes = 0;
  double sum = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    bytes += mesh::bytes_at_rest(piece);
    std::vector<double> sizes(piece.vertex_count());
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) sizes[v] = field(piece.point(v));
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const mesh::LocalIndex* v = piece.cell(c);
      for (const auto& [i, j] : mesh::tetrahedron_edges) {
        const double length =
            2 * distance(piece.point(v[i]), piece.point(v[j])) / (sizes[v[i]] + sizes[v[j]]);
        sum += length;
        good += length >= shortest && length <= longest;
      }
    }
    edges += 6 * static_cast<std::int64_t>(piece.cell_count());
  }
  const auto all = static_cast<double>(std::max<std::int64_t>(1, communicator.sum(edges)));
  return {static_cast<double>(communicator.sum(good)) / all, communicator.sum(sum) / all,
          6 * static_cast<double>(communicator.sum(bytes)) / all};
}

}  // namespace aeroloom::pipeline
