#include "improve/improver.hpp"

#include "improve/borders/bad_cells.hpp"
#include "improve/borders/balance.hpp"
#include "improve/borders/border_smoothing.hpp"
#include "improve/borders/cavity_improver.hpp"
#include "improve/corner_trials.hpp"
#include "improve/mending_queue.hpp"
#include "improve/operations/corner_relief.hpp"
#include "improve/operations/mean_ratio_smoothing.hpp"
#include "improve/tet_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/tet_quality.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/progress.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

namespace aeroloom::improve {
namespace {

BadState state_of(const TetMesh& mesh) {
  Examination examination(mesh.measure());
  for (mesh::LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.is_alive(t)) examination.add(mesh.quality(t), mesh.points(t));
  }
  return examination.state;
}

/// Degrees: least angles of the lattice off the surface, where its tetrahedra come from a table, are not
/// below (34.9 at the perturbations that are allowed).
constexpr double lattice_angle = 33;

/// The state of a piece that is left as it is: off the boundary, with nothing in it worse than in a lattice,
/// which meets the target. Its shape on average is the lattice's too, and reading it in would cost most of
/// what is spent on it. Nothing for others, which are looked at until the first such tetrahedron.
std::optional<BadState> look_at_lattice(const mesh::Piece& piece, const ImproveOptions& options) {
  if (piece.boundary_count() > 0 || options.target_angle > lattice_angle) return std::nullopt;
  const mesh::TetQuality measure(lattice_angle);
  Examination examination(measure);
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const auto p = points_of(piece, t);
    examination.add(measure(p[0], p[1], p[2], p[3]), p);
    if (examination.state.bad > 0) return std::nullopt;
  }
  return examination.state;
}

/// The expected cost of a piece of so many tetrahedra, so many of them bad: reading it in and looking at all,
/// and work on each bad tetrahedron, in the time of reading one tetrahedron in (measured: 0.5 and 25
/// microseconds).
double expected_work(double cells, double bad) {
  constexpr double per_bad = 50;
  return cells + per_bad * bad;
}

constexpr double work_per_lattice_cell =
    0.1;  // it is looked at and not read in; of reading one in, chosen, not measured

double expected_work(const mesh::Piece& piece, const ImproveOptions& options) {
  if (look_at_lattice(piece, options)) return work_per_lattice_cell * static_cast<double>(piece.cell_count());
  const mesh::TetQuality measure(options.target_angle);
  std::int64_t bad = 0;
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    bad += quality_of(piece, t, measure) < measure.target();
  }
  return expected_work(piece.cell_count(), static_cast<double>(bad));
}

/// Sweeps over what misses the target once corners are relieved, which gives it other surroundings.
constexpr int sweeps_after_relief = 3;

}  // namespace

ImproveReport improve_piece(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source,
                            std::vector<mesh::LocalIndex>* numbered, Effort effort) {
  const mesh::TetQuality measure(options.target_angle);
  ImproveReport report;
  if (numbered) {
    numbered->resize(piece.vertex_count());
    std::iota(numbered->begin(), numbered->end(), 0);
  }
  const auto note_before = [&](const BadState& state) {
    report.bad_before = report.bad_after = state.bad;
    report.min_angle_before = report.min_angle_after = state.least_angle;
  };
  if (!options.enabled) {
    note_before(examine(piece, measure));
    return report;
  }

  const AttainableQuality strips(piece, measure);
  const AttainableQuality attainable = effort == Effort::unsparing ? AttainableQuality(measure) : strips;
  TetMesh mesh(piece, measure, options.boundary_may_change);
  note_before(state_of(mesh));
  const ChangeLimits limits(source.sizes, &strips, effort);
  MendingQueue queue(mesh, attainable, limits, effort,
                     options.boundary_may_change ? source.locator : nullptr);
  queue.run(options.sweeps);
  std::optional<MendingQueue> again;
  if (const std::int64_t relieved = CornerRelief(limits).run(mesh); relieved > 0) {
    report.replaced += relieved;
    again.emplace(mesh, attainable, limits, effort, options.boundary_may_change ? source.locator : nullptr);
    again->run(sweeps_after_relief);
    report.replaced += CornerRelief(limits).run(mesh);
  }
  report.replaced += CornerTrials(source.sizes, options.corner_trials, effort).run(mesh);
  report.smoothed += MeanRatioSmoothing().run(mesh, options.relaxation);
  const BadState after = state_of(mesh);
  mesh.finish();
  if (numbered) *numbered = mesh.origin();
  report.changed_triangles = mesh.changed_triangles();

  report.bad_after = after.bad;
  report.min_angle_after = after.least_angle;
  for (const MendingQueue* each : {&queue, again ? &*again : nullptr}) {
    if (each == nullptr) continue;
    report.smoothed += each->smoothed();
    report.slid += each->slid();
    report.replaced += each->replaced();
  }
  return report;
}

namespace {

/// The rounds for the last ones: larger cavities, the surface in them, the best of several trials each, so
/// that no order of changes decides.
constexpr int last_rounds = 3;
constexpr int most_trials = 8;
constexpr cavities::CavityExtent last_extent{2, true};

/// Trials, so many that they are no burden, for each of the bad ones: one takes about as long as improving
/// ten thousand tetrahedra. None where more are left than 320 and one in 3,000. What more and fewer gave is
/// in benchmarks/results/improvement.md.
int affordable_trials(const mesh::DistributedMesh& mesh, std::int64_t bad) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::int64_t cells = 0;
  for (const mesh::Piece& piece : mesh.pieces) cells += piece.cell_count();
  constexpr std::int64_t of_any_mesh = 320, cells_per_trial = 3000;
  const std::int64_t budget = of_any_mesh + communicator.sum(cells) / cells_per_trial;
  return static_cast<int>(std::min<std::int64_t>(most_trials, budget / std::max<std::int64_t>(1, bad)));
}

/// The rounds in which borders of pieces are inside of cavities.
void improve_across(mesh::DistributedMesh& mesh, const ImproveOptions& options, const MeshSource& source,
                    ImproveReport& total) {
  const parallel::Communicator communicator = mesh.communicator;
  if (!options.enabled) return;
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  const mesh::TetQuality measure(options.target_angle);
  mesh::SharedVertices shared(mesh);
  const std::int64_t border_moves = smooth_borders(mesh, shared, measure, options.relaxation);
  if (communicator.rank() == 0) total.smoothed += border_moves;
  // Where borders stayed as they were, all is known already.
  if (border_moves == 0 && communicator.sum(total.bad_after) == 0) return;

  BadCells bad(mesh, measure);
  cavities::CavityClaims claims;
  CavityImprover improver(mesh, options, source);
  const auto refill = [&](cavities::CavityExtent extent, int trials, int shift) {
    parallel::begin_round();
    const auto improve = [&](const cavities::Cavity& cavity) {
      const double begin = parallel::cpu_seconds();
      auto refilling = trials > 0 ? improver.improve_by_trials(cavity, trials, shift, total)
                                  : improver.improve(cavity, total);
      parallel::note_task({"cavity", static_cast<std::int64_t>(cavity.id),
                           static_cast<double>(cavity.tets.size()), parallel::cpu_seconds() - begin,
                           static_cast<std::int64_t>(cavity.tets.size() * sizeof(cavity.tets[0]))});
      return refilling;
    };
    bad.update(mesh, cavities::refill_cavities(mesh, shared, {claims, extent, improve}));
    shared = mesh::SharedVertices(mesh);
    shared.drop_unshared(mesh);  // cavities name more than borders
  };
  int shift = 0;
  parallel::Progress progress("improve", options.shifted_rounds + last_rounds, "tetrahedra to improve");
  const auto claim = [&](Effort effort) {
    const std::int64_t left = communicator.sum(claim_for_bad(mesh, bad, measure, shift, effort, claims));
    progress.set_done(shift, left);
    return left;
  };
  for (; shift < options.shifted_rounds && claim(Effort::sparing) > 0; ++shift) refill({}, 0, shift);
  for (const int end = shift + last_rounds; options.shifted_rounds > 0 && shift < end; ++shift) {
    const std::int64_t left = claim(Effort::unsparing);
    const int trials = affordable_trials(mesh, left);
    if (left == 0 || trials == 0) break;
    refill(last_extent, trials, shift);
  }
  const BadState after = bad.state(mesh);
  total.bad_after = after.bad;
  total.min_angle_after = after.least_angle;
}

/// As improve_piece(), or what came of it in an earlier run; of pieces of the lattice what they are.
ImproveReport improve_or_find(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source,
                              parallel::TaskStore* tasks) {
  if (const auto lattice = options.enabled ? look_at_lattice(piece, options) : std::nullopt) {
    ImproveReport report;
    report.min_angle_before = report.min_angle_after = lattice->least_angle;
    report.is_lattice = true;
    return report;
  }
  if (tasks == nullptr || !options.enabled) return improve_piece(piece, options, source);
  const parallel::Digest key =
      parallel::Digester().value(options.target_angle).bytes(parallel::to_wire(piece)).result();
  if (const std::optional<parallel::Bytes> known = tasks->find(key)) {
    ImproveReport report;
    std::tie(report, piece) = parallel::from_wire<std::tuple<ImproveReport, mesh::Piece>>(*known);
    return report;
  }
  const ImproveReport report = improve_piece(piece, options, source);
  tasks->keep(key, parallel::to_wire(std::tie(report, piece)));
  return report;
}

/// For one target.
ImproveReport improve_for_target(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                                 const MeshSource& source, parallel::TaskStore* tasks) {
  const parallel::Communicator communicator = mesh.communicator;
  parallel::begin_round();
  ImproveReport total;
  total.min_angle_before = total.min_angle_after = 180;
  std::vector<double> work;
  parallel::agree(communicator, [&] {
    if (mesh.kind != mesh::CellKind::tetrahedron)
      throw std::logic_error("improve: the mesh has no tetrahedra");
    if (!options.enabled || communicator.size() < 2) return;
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    for (const mesh::Piece& piece : mesh.pieces) work.push_back(expected_work(piece, options));
  });
  if (options.enabled) mesh::SharedVertices(mesh).drop_unshared(mesh);
  if (options.enabled && communicator.size() > 1) balance_pieces(mesh, work);
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    parallel::Progress progress("improve", static_cast<std::int64_t>(mesh.pieces.size()), "tetrahedra");
    for (mesh::Piece& piece : mesh.pieces) {
      const double begin = parallel::cpu_seconds();
      const auto cells = static_cast<double>(piece.cell_count());
      const ImproveReport mine = improve_or_find(piece, options, source, tasks);
      const double load = mine.is_lattice ? work_per_lattice_cell * cells
                                          : expected_work(cells, static_cast<double>(mine.bad_before));
      parallel::note_task(
          {"improved piece", piece.id, load, parallel::cpu_seconds() - begin, mesh::bytes_at_rest(piece)});
      total.bad_before += mine.bad_before;
      total.bad_after += mine.bad_after;
      total.add_changes(mine);
      total.min_angle_before = std::min(total.min_angle_before, mine.min_angle_before);
      total.min_angle_after = std::min(total.min_angle_after, mine.min_angle_after);
      parallel::add_pieces(1);
      progress.advance(1, piece.cell_count());
    }
  });
  improve_across(mesh, options, source, total);
  for (std::int64_t* count : {&total.bad_before, &total.bad_after, &total.smoothed, &total.slid,
                              &total.replaced, &total.changed_triangles}) {
    *count = communicator.sum(*count);
  }
  for (double* angle : {&total.min_angle_before, &total.min_angle_after})
    *angle = communicator.minimum(*angle);
  return total;
}

/// The fraction of all tetrahedra with a smaller angle. Collective.
double fraction_below(const mesh::DistributedMesh& mesh, double angle) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::int64_t below = 0, cells = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    cells += piece.cell_count();
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* c = piece.cell(t);
      below +=
          mesh::dihedral_range(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]))
              .smallest < angle;
    }
  }
  below = communicator.sum(below);
  return static_cast<double>(below) / static_cast<double>(std::max<std::int64_t>(1, communicator.sum(cells)));
}

/// Brings what a report says about the target up to date after further work. Collective.
void examine_again(const mesh::DistributedMesh& mesh, const mesh::TetQuality& measure,
                   ImproveReport& report) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::int64_t bad = 0;
  double least = 180;
  for (const mesh::Piece& piece : mesh.pieces) {
    const BadState state = examine(piece, measure);
    bad += state.bad;
    least = std::min(least, state.least_angle);
  }
  report.bad_after = communicator.sum(bad);
  report.min_angle_after = communicator.minimum(least);
}

}  // namespace

ImproveReport improve_mesh(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                           const MeshSource& source, parallel::TaskStore* tasks) {
  constexpr double largest_target =
      50;  // degrees; a regular tetrahedron has 70.5, those of the lattice 60 and 90; chosen
  ImproveReport total = improve_for_target(mesh, options, source, tasks);
  if (!options.enabled || options.percentiles.empty()) return total;
  std::vector<PercentileTarget> targets = options.percentiles;
  std::sort(targets.begin(), targets.end(),
            [](const PercentileTarget& a, const PercentileTarget& b) { return a.angle < b.angle; });
  for (const PercentileTarget& target : targets) {
    if (fraction_below(mesh, target.angle) <= target.fraction) continue;
    ImproveOptions more = options;
    more.target_angle = std::min(target.angle, largest_target);
    total.add_changes(improve_for_target(mesh, more, source, tasks));
  }
  examine_again(mesh, mesh::TetQuality(options.target_angle), total);
  return total;
}

}  // namespace aeroloom::improve
