#include "mesh/quality/neighbour_volumes.hpp"

#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace aeroloom::mesh {

namespace {

std::vector<double> volumes_of(const Piece& piece) {
  std::vector<double> volumes(static_cast<std::size_t>(piece.total_cell_count()));
  std::array<geometry::Vec3, most_corners> points;
  for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
    const CellOfPiece cell = cell_of(piece, c);
    points_of(piece, cell, points.data());
    volumes[static_cast<std::size_t>(c)] = cell_volume(cell.shape, points.data());
  }
  return volumes;
}

}  // namespace

NeighbourVolumes compare_volumes(const DistributedMesh& mesh, const FaceLinks& links) {
  NeighbourVolumes result;
  for (const Piece& piece : mesh.pieces) {
    result.volumes.push_back(volumes_of(piece));
    result.ratios.emplace_back(result.volumes.back().size(), 0.0);
    result.jumps.emplace_back(result.volumes.back().size(), 0.0);
  }
  const auto meet = [&](std::size_t piece, LocalIndex cell, double other) {
    const auto c = static_cast<std::size_t>(cell);
    double &ratio = result.ratios[piece][c], &jump = result.jumps[piece][c];
    const double own = result.volumes[piece][c], to_other = volume_ratio(own, other);
    ratio = std::max(ratio, to_other);
    if (other > own) jump = std::max(jump, to_other);
  };
  std::vector<Told<double>> volumes;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    std::size_t side = 0;
    for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
      for (const std::size_t end = first_side(piece, c + 1); side < end; ++side) {
        const CellNeighbour& other = links.pieces[i].neighbours[side];
        if (!other.exists()) continue;
        if (other.piece == piece.id) {
          meet(i, c, result.volumes[i][static_cast<std::size_t>(other.cell)]);
        } else {
          volumes.push_back({other, result.volumes[i][static_cast<std::size_t>(c)]});
        }
      }
    }
  }
  for (const auto& [cell, volume] : tell_cells(mesh, std::move(volumes)))
    meet(position_of(mesh, cell.piece), cell.cell, volume);
  return result;
}

}  // namespace aeroloom::mesh
