/// Lists of the bad tetrahedra of all pieces. They are updated after each round of cavities without a scan of
/// all cells.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/limits/examination.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <vector>

namespace aeroloom::improve {

class BadCells {
public:
  /// Scans all cells of this rank.
  BadCells(const mesh::DistributedMesh& mesh, const mesh::TetQuality& measure);

  /// Removes the cells that a round replaced and adds the bad ones among the new cells.
  void update(const mesh::DistributedMesh& mesh, const cavities::CavityRound& round);

  /// Bad cells of a local piece, ascending.
  const std::vector<mesh::LocalIndex>& of_piece(std::size_t p) const { return _cells[p]; }
  /// State of this rank. Scans all cells for the smallest angle only if no bad cell can have it.
  BadState state(const mesh::DistributedMesh& mesh) const;

private:
  void add(const mesh::Piece& piece, std::size_t p, mesh::LocalIndex first);

  mesh::TetQuality _measure;
  std::vector<std::vector<mesh::LocalIndex>> _cells;  ///< by local piece
};

}  // namespace aeroloom::improve
