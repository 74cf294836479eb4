/// The tetrahedra of pieces that miss the target, kept up to date from round to round of cavities without
/// another look at all.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/limits/examination.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <vector>

namespace aeroloom::improve {

class BadCells {
public:
  /// Looks at every cell of this rank.
  BadCells(const mesh::DistributedMesh& mesh, const mesh::TetQuality& measure);

  /// Follows a round: what it left, and those among what it brought.
  void update(const mesh::DistributedMesh& mesh, const cavities::CavityRound& round);

  /// Of a local piece, ascending.
  const std::vector<mesh::LocalIndex>& of_piece(std::size_t p) const { return _cells[p]; }
  /// Of this rank. The least angle is looked for among all cells only where no bad one has it.
  BadState state(const mesh::DistributedMesh& mesh) const;

private:
  void add(const mesh::Piece& piece, std::size_t p, mesh::LocalIndex first);

  mesh::TetQuality _measure;
  std::vector<std::vector<mesh::LocalIndex>> _cells;  ///< per local piece
};

}  // namespace aeroloom::improve
