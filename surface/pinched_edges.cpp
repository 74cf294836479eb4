#include "surface/pinched_edges.hpp"

#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <array>

namespace aeroloom::surface {
namespace {

using mesh::LocalIndex;

/// Ascending.
using Corners = std::array<LocalIndex, 3>;
using Ends = std::array<LocalIndex, 2>;

std::vector<Ends> pinched_of(const mesh::Piece& piece) {
  std::vector<Ends> edges, pinched;
  std::vector<Corners> triangles;
  edges.reserve(3 * static_cast<std::size_t>(piece.cell_count()));
  triangles.reserve(static_cast<std::size_t>(piece.cell_count()));
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* corners = piece.cell(t);
    Corners sorted{corners[0], corners[1], corners[2]};
    std::sort(sorted.begin(), sorted.end());
    triangles.push_back(sorted);
    edges.push_back({sorted[0], sorted[1]});
    edges.push_back({sorted[0], sorted[2]});
    edges.push_back({sorted[1], sorted[2]});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i)
    if (edges[i] == edges[i - 2]) pinched.push_back(edges[i]);
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t i = 1; i < triangles.size(); ++i)
    if (triangles[i] == triangles[i - 1]) pinched.push_back({triangles[i][0], triangles[i][1]});
  std::sort(pinched.begin(), pinched.end());
  pinched.erase(std::unique(pinched.begin(), pinched.end()), pinched.end());
  return pinched;
}

}  // namespace

std::vector<PinchedEdge> find_pinched_edges(const mesh::DistributedMesh& surface) {
  std::vector<PinchedEdge> mine;
  {
    const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
    for (const mesh::Piece& piece : surface.pieces) {
      for (const auto& [a, b] : pinched_of(piece)) {
        const geometry::Vec3 from = piece.point(a), to = piece.point(b);
        mine.push_back({piece.id, 0.5 * (from + to), distance(from, to)});
      }
    }
  }
  return surface.communicator.gather_sorted(mine, &PinchedEdge::piece);
}

}  // namespace aeroloom::surface
