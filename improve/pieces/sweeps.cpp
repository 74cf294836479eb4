#include "improve/pieces/sweeps.hpp"

#include "improve/operations/operations.hpp"

namespace aeroloom::improve {
namespace {

/// Tries of one sweep, in tetrahedra that it began with, so that it ends where the surface leaves no room for
/// good ones (docs/improvement.md). Chosen, not measured.
constexpr std::int64_t tries_per_task = 4;
constexpr std::int64_t least_tries = 1000;
/// A sweep with fewer gains is the last one. Chosen, not measured.
constexpr std::int64_t tasks_per_gain = 50;

}  // namespace

Sweeps::Sweeps(TetMesh& mesh, const LocalTarget& local_target, const ChangeLimits& limits, Effort effort,
               cad::PointLocator* locator)
    : _mesh(mesh),
      _queue(mesh, local_target, last_level_in_narrow_regions()),
      _context(mesh, local_target, limits, effort, locator, _queue),
      _operations(operations().size()) {}

void Sweeps::follow_removal(const std::vector<LocalIndex>& fresh) {
  _queue.rest_all_but(fresh, last_level());
  _context.forbid_over_constrained();
}

void Sweeps::run(int most) {
  for (int sweep_number = 1; sweep_number <= most; ++sweep_number) {
    const int level = level_of_sweep(sweep_number);
    const Gains done = sweep(level);
    if (level == last_level() && done.gains <= done.tasks / tasks_per_gain) return;
  }
}

Sweeps::Gains Sweeps::sweep(int level) {
  Gains done{_queue.fill(), 0};
  // A change may leave other tetrahedra below the target, endlessly if gains are small.
  for (std::int64_t tries = tries_per_task * done.tasks + least_tries; tries > 0; --tries) {
    const std::optional<LocalIndex> t = _queue.pop(level);
    if (!t) break;
    if (improve(*t, level)) {
      ++done.gains;
    } else {
      _queue.note_failure(*t, level);
    }
  }
  return done;
}

bool Sweeps::improve(LocalIndex t, int level) {
  const double fraction = _mesh.quality(t) / _queue.target_of(t);
  for (std::size_t i = 0; i < _operations.size(); ++i) {
    const ListedOperation& listed = operations()[i];
    if (listed.from_sweep > level || fraction >= listed.below || (listed.is_costly && _queue.skips_costly(t)))
      continue;
    if (!_operations[i]) _operations[i] = listed.make(_context);
    if (_operations[i]->improve(_context, t)) return true;
  }
  return false;
}

}  // namespace aeroloom::improve
