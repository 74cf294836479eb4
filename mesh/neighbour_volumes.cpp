#include "mesh/neighbour_volumes.hpp"

#include "mesh/cell_measures.hpp"
#include "mesh/delivery.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {

namespace {

using parallel::Rank;

/// Tells a cell the volume of its neighbour.
struct VolumeMessage {
  PieceId piece;
  LocalIndex cell;
  double volume;

  static constexpr auto fields() {
    return std::tuple(&VolumeMessage::piece, &VolumeMessage::cell, &VolumeMessage::volume);
  }
};

std::vector<double> volumes_of(const Piece& piece) {
  std::vector<double> volumes(static_cast<std::size_t>(piece.total_cell_count()));
  std::array<geometry::Vec3, 6> points;
  for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
    const CellOfPiece cell = cell_of(piece, c);
    points_of(piece, cell, points.data());
    volumes[static_cast<std::size_t>(c)] = cell_volume(cell.shape, points.data());
  }
  return volumes;
}

}  // namespace

NeighbourVolumes compare_volumes(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                                 const FaceLinks& links) {
  NeighbourVolumes result;
  for (const Piece& piece : mesh.pieces) {
    result.volumes.push_back(volumes_of(piece));
    result.ratios.emplace_back(result.volumes.back().size(), 0.0);
  }
  const std::vector<Rank> rank_of =
      gather_by_piece(communicator, mesh, std::vector<Rank>(mesh.pieces.size(), communicator.rank()));
  const auto meet = [&](std::size_t piece, LocalIndex cell, double other) {
    double& ratio = result.ratios[piece][static_cast<std::size_t>(cell)];
    ratio = std::max(ratio, volume_ratio(result.volumes[piece][static_cast<std::size_t>(cell)], other));
  };
  std::vector<VolumeMessage> messages;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    std::size_t side = 0;
    for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
      for (const std::size_t end = first_side(piece, c + 1); side < end; ++side) {
        const CellBehind& other = links.pieces[i].behind[side];
        if (!other.exists()) continue;
        if (rank_of[static_cast<std::size_t>(other.piece)] == communicator.rank()) {
          meet(i, c, result.volumes[position_of(mesh, other.piece)][static_cast<std::size_t>(other.cell)]);
        } else {
          messages.push_back({other.piece, other.cell, result.volumes[i][static_cast<std::size_t>(c)]});
        }
      }
    }
  }
  for (const VolumeMessage& message : deliver(communicator, std::move(messages), [&](const VolumeMessage& m) {
         return rank_of[static_cast<std::size_t>(m.piece)];
       }))
    meet(position_of(mesh, message.piece), message.cell, message.volume);
  return result;
}

}  // namespace aeroloom::mesh
