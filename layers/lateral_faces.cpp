#include "layers/lateral_faces.hpp"

#include "layers/layer_cells.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace aeroloom::layers {

using mesh::GlobalIndex;
using mesh::LocalIndex;

namespace {

/// An edge of a triangle by the numbers of its ends, ascending.
struct WallEdge {
  std::array<GlobalIndex, 2> ends;
  LateralEdge here;
  std::int32_t bears;  ///< 1: its triangle bears layers
  auto place() const { return std::tuple(here.piece, here.half_edge); }
};

/// Edges between CAD faces, whose ends other pieces know, with a column at an end.
std::vector<WallEdge> edges_of_faces(const mesh::NumberedMesh& wall, const Columns& columns) {
  std::vector<WallEdge> edges;
  for (std::size_t p = 0; p < wall.pieces.size(); ++p) {
    const mesh::Piece& piece = wall.pieces[p];
    const std::vector<GlobalIndex>& numbers = wall.numbering.vertices[p];
    std::vector<std::uint8_t> shared(piece.vertex_count(), 0);
    for (const LocalIndex v : piece.shared_vertices) shared[v] = 1;
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const std::int32_t patch = piece.triangle_patch[t];
      for (int i = 0; i < 3; ++i) {
        const LocalIndex a = piece.cell(t)[i], b = piece.cell(t)[(i + 1) % 3];
        const bool grows = columns.pieces[p].counts[a] > 0 || columns.pieces[p].counts[b] > 0;
        if (!grows || !shared[a] || !shared[b]) continue;
        const auto [low, high] = std::minmax(numbers[a], numbers[b]);
        edges.push_back({{low, high},
                         {piece.id, 3 * t + i, piece.triangle_face[t], patch},
                         bears_layers(wall, patch) ? 1 : 0});
      }
    }
  }
  return edges;
}

}  // namespace

std::vector<LateralEdge> find_lateral_edges(const mesh::NumberedMesh& wall, const Columns& columns) {
  const mesh::Rendezvous meeting(wall.communicator, edges_of_faces(wall, columns), &WallEdge::ends,
                                 &WallEdge::place);
  std::vector<LateralEdge> found =
      meeting.answer<LateralEdge>([](std::span<const mesh::Received<WallEdge>> group, const auto& reply) {
        const auto other = std::find_if(group.begin(), group.end(),
                                        [](const auto& received) { return received.item.bears == 0; });
        if (other == group.end()) return;
        for (const mesh::Received<WallEdge>& received : group) {
          if (received.item.bears == 0) continue;
          LateralEdge edge = received.item.here;
          edge.face = other->item.here.face;
          edge.patch = other->item.here.patch;
          reply(received, edge);
        }
      });
  std::sort(found.begin(), found.end(), [](const LateralEdge& a, const LateralEdge& b) {
    return std::tie(a.piece, a.half_edge) < std::tie(b.piece, b.half_edge);
  });
  return found;
}

}  // namespace aeroloom::layers
