#include "pipeline/size_conformity.hpp"

#include "mesh/cell_stars.hpp"

#include <algorithm>
#include <vector>

namespace aeroloom::pipeline {

using mesh::LocalIndex;

SizeConformity measure_conformity(const parallel::Communicator& communicator,
                                  const mesh::DistributedMesh& mesh, const sizing::SizeField& field) {
  constexpr double shortest = 0.7, longest = 1.4;
  std::int64_t edges = 0, good = 0, bytes = 0, cells = 0;
  double sum = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    bytes += mesh::bytes_at_rest(piece);
    cells += piece.cell_count();
    std::vector<double> sizes(piece.vertex_count());
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) sizes[v] = field(piece.point(v));
    mesh::for_each_edge(piece, [&](LocalIndex a, LocalIndex b) {
      const double length = 2 * distance(piece.point(a), piece.point(b)) / (sizes[a] + sizes[b]);
      sum += length;
      good += length >= shortest && length <= longest;
      ++edges;
    });
  }
  const auto all = static_cast<double>(std::max<std::int64_t>(1, communicator.sum(edges)));
  const auto all_cells = static_cast<double>(std::max<std::int64_t>(1, communicator.sum(cells)));
  return {static_cast<double>(communicator.sum(good)) / all, communicator.sum(sum) / all,
          static_cast<double>(communicator.sum(bytes)) / all_cells};
}

}  // namespace aeroloom::pipeline
