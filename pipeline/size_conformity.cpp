#include "pipeline/size_conformity.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::pipeline {
namespace {

using mesh::LocalIndex;

/// Calls visit(a, b), a < b, once for each edge of a piece.
template <class Visit>
void for_each_edge(const mesh::Piece& piece, const Visit& visit) {
  std::vector<std::int64_t> first(piece.vertex_count() + 2, 0);
  const auto for_each_use = [&](const auto& use) {
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const LocalIndex* v = piece.cell(c);
      for (const auto& [i, j] : mesh::tetrahedron_edges) use(std::min(v[i], v[j]), std::max(v[i], v[j]));
    }
  };
  for_each_use([&](LocalIndex a, LocalIndex) { ++first[a + 2]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<LocalIndex> ends(6 * static_cast<std::size_t>(piece.cell_count()));
  for_each_use([&](LocalIndex a, LocalIndex b) { ends[first[a + 1]++] = b; });
  for (LocalIndex a = 0; a < piece.vertex_count(); ++a) {
    const auto begin = ends.begin() + first[a], end = ends.begin() + first[a + 1];
    std::sort(begin, end);
    std::for_each(begin, std::unique(begin, end), [&](LocalIndex b) { visit(a, b); });
  }
}

}  // namespace

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
    for_each_edge(piece, [&](LocalIndex a, LocalIndex b) {
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
