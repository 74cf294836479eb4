#include "improve/attribution/size_conformity.hpp"

#include "mesh/data/cell_stars.hpp"

#include <algorithm>

namespace aeroloom::attribution {

using mesh::LocalIndex;

SizeConformity measure_conformity(const mesh::DistributedMesh& mesh, const sizing::SizeField& field) {
  const parallel::Communicator& communicator = mesh.communicator;
  // Over the size: halving an edge of the largest ratio gives the smallest. Ratios between conform.
  constexpr double shortest = 0.7, longest = 1.4;
  constexpr double fairly_short = 0.5, fairly_long = 2;  // a factor that solvers bear, as users name it
  constexpr LocalIndex most_looked_at = 200;             // vertices of a piece, about
  std::int64_t edges = 0, good = 0, fair = 0, bytes = 0, cells = 0;
  double sum = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    if (!piece.layers.empty()) continue;  // flat by intention
    bytes += mesh::bytes_at_rest(piece);
    cells += piece.cell_count();
    const LocalIndex stride = 1 + piece.vertex_count() / most_looked_at;
    mesh::for_each_edge(
        piece,
        [&](LocalIndex a, LocalIndex b) {
          const double length =
              distance(piece.point(a), piece.point(b)) / field(0.5 * (piece.point(a) + piece.point(b)));
          sum += length;
          good += length >= shortest && length <= longest;
          fair += length >= fairly_short && length <= fairly_long;
          ++edges;
        },
        stride);
  }
  const auto all = static_cast<double>(std::max<std::int64_t>(1, communicator.sum(edges)));
  const auto all_cells = static_cast<double>(std::max<std::int64_t>(1, communicator.sum(cells)));
  return {static_cast<double>(communicator.sum(good)) / all,
          static_cast<double>(communicator.sum(fair)) / all, communicator.sum(sum) / all,
          static_cast<double>(communicator.sum(bytes)) / all_cells};
}

}  // namespace aeroloom::attribution
