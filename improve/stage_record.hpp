/// The bookkeeping of the stage: its report, its tasks, sums over ranks.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/distributed_mesh.hpp"

namespace aeroloom::improve {

/// What one rank did for one target.
class StageRecord {
public:
  /// Begins a round of the stage.
  StageRecord();

  /// A piece of so many tetrahedra was improved since then, in CPU seconds of this rank.
  void add_piece(const mesh::Piece& piece, double cells, double begin, const ImproveReport& of_piece);
  /// A cavity was improved since then.
  void note_cavity(const cavities::Cavity& cavity, double begin);
  /// The report of all ranks of a mesh, the same on each. Collective.
  ImproveReport total(const mesh::DistributedMesh& mesh) const;

  ImproveReport mine;  ///< of this rank
};

}  // namespace aeroloom::improve
