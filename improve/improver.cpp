#include "improve/improver.hpp"

#include "improve/borders/balance.hpp"
#include "improve/borders/border_smoothing.hpp"
#include "improve/cavity_rounds.hpp"
#include "improve/expected_work.hpp"
#include "improve/limits/examination.hpp"
#include "improve/stage_record.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/tet_quality.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"
#include "parallel/storage/task_store.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace aeroloom::improve {
namespace {

/// As improve_piece(), or its stored result of an earlier run. Pieces of the lattice stay as they are.
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

/// The steps of docs/improvement.md over a mesh, for one target. All are collective.
struct MeshImprover {
  mesh::DistributedMesh& mesh;
  const ImproveOptions& options;
  const MeshSource& source;
  parallel::TaskStore* tasks;
  const parallel::Communicator communicator = mesh.communicator;
  StageRecord record = {};
  /// Nothing if smoothing moved no vertex and no tetrahedron is below target.
  std::optional<CavityRounds> rounds = {};

  void balance() {
    std::vector<double> work;
    parallel::agree(communicator, [&] {
      if (mesh.kind != mesh::CellKind::tetrahedron)
        throw std::logic_error("improve: the mesh has no tetrahedra");
      if (!options.enabled || communicator.size() < 2) return;
      const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
      for (const mesh::Piece& piece : mesh.pieces) work.push_back(expected_work(piece, options));
    });
    if (!options.enabled) return;
    mesh::SharedVertices(mesh).drop_unshared(mesh);
    if (communicator.size() > 1) balance_pieces(mesh, work);
  }

  void improve_pieces() {
    parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
      parallel::Progress progress("improve", static_cast<std::int64_t>(mesh.pieces.size()), "tetrahedra");
      for (mesh::Piece& piece : mesh.pieces) {
        const double begin = parallel::cpu_seconds();
        const auto cells = static_cast<double>(piece.cell_count());
        record.add_piece(piece, cells, begin, improve_or_find(piece, options, source, tasks));
        progress.advance(1, piece.cell_count());
      }
    });
  }

  void smooth_borders() {
    if (!options.enabled) return;
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    const mesh::TetQuality measure(options.target_angle);
    mesh::SharedVertices shared(mesh);
    const std::int64_t moves = improve::smooth_borders(mesh, shared, measure, options.relaxation);
    if (communicator.rank() == 0) record.mine.smoothed += moves;
    if (moves > 0 || communicator.sum(record.mine.bad_after) > 0)
      rounds.emplace(mesh, std::move(shared), options, source, record);
  }

  void improve_cavities() {
    if (!rounds) return;
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    rounds->improve_cavities();
  }

  void polish_last() {
    if (!rounds) return;
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    rounds->polish_last();
    rounds->note_state();
  }
};

/// For one target. The numbers are those of the steps in docs/improvement.md.
ImproveReport improve_for_target(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                                 const MeshSource& source, parallel::TaskStore* tasks) {
  MeshImprover improver{mesh, options, source, tasks};
  improver.balance();           // 1. distribution
  improver.improve_pieces();    // 2. sweeps, 3. over-constrained tetrahedra, 4. average (improve_piece)
  improver.smooth_borders();    // 5. borders: the average
  improver.improve_cavities();  // 5. borders: cavities
  improver.polish_last();       // 6. last tetrahedra
  return improver.record.total(mesh);
}

/// The fraction of all tetrahedra with a smaller angle. Collective.
double fraction_below(const mesh::DistributedMesh& mesh, double angle) {
  std::int64_t below = 0, cells = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    cells += piece.cell_count();
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const auto p = points_of(piece, t);
      below += mesh::dihedral_range(p[0], p[1], p[2], p[3]).smallest < angle;
    }
  }
  below = mesh.communicator.sum(below);
  cells = mesh.communicator.sum(cells);
  return static_cast<double>(below) / static_cast<double>(std::max<std::int64_t>(1, cells));
}

/// Brings what a report says about the target up to date after further work. Collective.
void examine_again(const mesh::DistributedMesh& mesh, const mesh::TetQuality& measure,
                   ImproveReport& report) {
  BadState all;
  for (const mesh::Piece& piece : mesh.pieces) {
    const BadState state = examine(piece, measure);
    all.bad += state.bad;
    all.least_angle = std::min(all.least_angle, state.least_angle);
  }
  report.note_after({mesh.communicator.sum(all.bad), mesh.communicator.minimum(all.least_angle)});
}

}  // namespace

ImproveReport improve_mesh(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                           const MeshSource& source, parallel::TaskStore* tasks) {
  constexpr double largest_target =
      50;  // degrees; a regular tetrahedron has 70.5, those of the lattice 60 and 90; chosen
  ImproveReport total = improve_for_target(mesh, options, source, tasks);
  if (!options.enabled || options.percentiles.empty()) return total;
  // 7. gate
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
