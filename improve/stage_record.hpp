/// Bookkeeping of the improvement stage: report, task records, sums over ranks.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/distributed_mesh.hpp"

namespace aeroloom::improve {

/// The record of this rank for one target quality.
class StageRecord {
public:
  /// Begins a round of the timing record.
  StageRecord();

  /// Records the improvement of a piece of `cells` tetrahedra, which began at `begin` (CPU seconds of this
  /// rank).
  void add_piece(const mesh::Piece& piece, double cells, double begin, const ImproveReport& of_piece);
  /// Records the replacement of a cavity, which began at `begin`.
  void note_cavity(const cavities::Cavity& cavity, double begin);
  /// The sum over all ranks of a mesh, equal on each. Collective.
  ImproveReport total(const mesh::DistributedMesh& mesh) const;

  ImproveReport mine;  ///< of this rank
};

}  // namespace aeroloom::improve
