/// The tetrahedra of pieces that miss the target, kept up to date from round to round of cavities without
/// another look at all.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// Adds tetrahedra to a state, their qualities known.
class Examination {
public:
  explicit Examination(const mesh::TetQuality& measure) : _target(measure.target()) {}
  void add(double quality, const std::array<geometry::Vec3, 4>& p);

  BadState state;

private:
  double _target;
  /// The quality is at most the sine of the smallest angle: above this nothing can lower the least angle.
  double _bound = 2;
};

std::array<geometry::Vec3, 4> points_of(const mesh::Piece& piece, mesh::LocalIndex cell);

/// The quality of a piece's cell.
double quality_of(const mesh::Piece& piece, mesh::LocalIndex cell, const mesh::TetQuality& measure);

BadState examine(const mesh::Piece& piece, const mesh::TetQuality& measure);

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
