/// The bookkeeping of the stage: its report, its tasks, sums over ranks.
#pragma once

#include "improve/borders/rounds.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

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
  void begin_round() { parallel::begin_round(); }
  /// The report of all ranks, the same on each. Collective.
  ImproveReport total(const parallel::Communicator& communicator) const;

  ImproveReport mine;  ///< of this rank

private:
};

}  // namespace aeroloom::improve
