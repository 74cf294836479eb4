#include "improve/cavity_rounds.hpp"

#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::improve {
namespace {

constexpr int last_rounds = 3;
constexpr int most_trials = 8;
constexpr cavities::CavityExtent last_extent{2, true};

/// Trials, so many that they are no burden, for each of the bad ones: one takes about as long as improving
/// ten thousand tetrahedra. None where more are left than 320 and one in 3,000 (docs/improvement.md has what
/// more and fewer gave).
int affordable_trials(const mesh::DistributedMesh& mesh, std::int64_t bad) {
  std::int64_t cells = 0;
  for (const mesh::Piece& piece : mesh.pieces) cells += piece.cell_count();
  constexpr std::int64_t of_any_mesh = 320, cells_per_trial = 3000;
  const std::int64_t budget = of_any_mesh + mesh.communicator.sum(cells) / cells_per_trial;
  return static_cast<int>(std::min<std::int64_t>(most_trials, budget / std::max<std::int64_t>(1, bad)));
}

}  // namespace

CavityRounds::CavityRounds(mesh::DistributedMesh& mesh, mesh::SharedVertices shared,
                           const ImproveOptions& options, const MeshSource& source, StageRecord& record)
    : _mesh(mesh),
      _shared(std::move(shared)),
      _options(options),
      _measure(options.target_angle),
      _record(record),
      _bad(mesh, _measure),
      _improver(mesh, options, source),
      _progress("improve", options.shifted_rounds + last_rounds, "tetrahedra to improve") {}

std::int64_t CavityRounds::claim(Effort effort) {
  const std::int64_t left =
      _mesh.communicator.sum(claim_for_bad(_mesh, _bad, _measure, _shift, effort, _claims));
  _progress.set_done(_shift, left);
  return left;
}

void CavityRounds::run_round(cavities::CavityExtent extent, int trials) {
  parallel::begin_round();
  const auto improve = [&](const cavities::Cavity& cavity) {
    const double begin = parallel::cpu_seconds();
    auto content = trials > 0 ? _improver.improve_by_trials(cavity, trials, _shift, _record.mine)
                              : _improver.improve(cavity, _record.mine);
    _record.note_cavity(cavity, begin);
    return content;
  };
  _bad.update(_mesh, cavities::replace_cavities(_mesh, _shared, {_claims, extent, improve}));
  _shared = mesh::SharedVertices(_mesh);
  _shared.drop_unshared(_mesh);  // a round names more vertices than those on borders
  ++_shift;
}

void CavityRounds::improve_cavities() {
  while (_shift < _options.shifted_rounds && claim(Effort::reduced) > 0) run_round({}, 0);
}

void CavityRounds::polish_last() {
  if (_options.shifted_rounds <= 0) return;
  for (int round = 0; round < last_rounds; ++round) {
    const std::int64_t left = claim(Effort::full);
    const int trials = affordable_trials(_mesh, left);
    if (left == 0 || trials == 0) break;
    run_round(last_extent, trials);
  }
}

}  // namespace aeroloom::improve
