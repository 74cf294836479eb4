#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/fault.hpp"
#include "volume/filling/core_pieces.hpp"
#include "volume/filling/decomposition_data.hpp"
#include "volume/filling/retry_policy.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {
namespace {

using parallel::ScopedCpu;

/// Fills zones until all are filled and fit together.
class ZoneFiller {
public:
  ZoneFiller(const VolumeInput& input, const Lattice& lattice, Shell& shell, VolumeReport& report)
      : _communicator(input.surface.communicator),
        _input(input),
        _lattice(lattice),
        _shell(shell),
        _report(report),
        _retries(input.options, lattice, shell, report),
        _budget(shell.zones.count()) {}

  mesh::DistributedMesh run(ZonePlan plan) {
    fill(std::move(plan));
    note_overlap();
    for (_report.rounds = 1;; ++_report.rounds) {
      const std::vector<ZoneIndex> pending = change_failed_or_disputed();
      if (pending.empty()) return assemble();
      _budget.spend(pending.size(), _report.rounds, _input.options.halo);
      fill(plan_zones(_lattice, _shell, pending, _retries.widths()));
    }
  }

private:
  std::vector<ZoneIndex> change_failed_or_disputed() {
    std::vector<ZoneIndex> pending =
        _retries.change_failed(std::exchange(_failures, {}), std::exchange(_demoted, {}), _diagnostics);
    return pending.empty() ? _retries.resolve_disputes(faces()) : pending;
  }

  // --- one round of filling

  void fill(ZonePlan plan) {
    parallel::begin_round();
    for (const ZoneLoad& load : plan.loads) _results.erase(load.zone), _work[load.zone] = load.work();
    std::erase_if(_results, [&](const auto& result) { return _retries.is_gone(result.first); });
    constexpr std::int64_t steps = 1000;  // of a wave, whatever its zones
    parallel::Progress progress("volume", steps * static_cast<std::int64_t>(plan.batches.size()),
                                "tetrahedra");
    std::int64_t waves = 0, made = 0;
    for (const SendPlan& batch : plan.batches) {
      std::vector<ZoneInput> inputs = gather_zone_inputs(_lattice, _shell, batch);
      parallel::agree(_communicator, [&] {
        for (std::size_t i = 0; i < inputs.size(); inputs[i++] = {}) {
          made += fill_one(inputs[i]);
          progress.set_done(waves * steps + static_cast<std::int64_t>((i + 1) * steps / inputs.size()), made);
        }
      });
      progress.set_done(++waves * steps, made);
    }
  }

  std::vector<ZoneFace> faces() const {
    std::vector<ZoneFace> faces;
    for (const auto& [zone, result] : _results)
      faces.insert(faces.end(), result.faces.begin(), result.faces.end());
    return faces;
  }

  /// Returns the number of tetrahedra made.
  std::int64_t fill_one(ZoneInput& zone) {
    const ScopedCpu task(ScopedCpu::As::task);
    const double begin = parallel::cpu_seconds(), seconds = _input.options.base_cpu_seconds;
    require_size(zone);
    _halo_points += static_cast<std::int64_t>(zone.problem.regions.size());
    const parallel::CrashNote note(fmt::format("stage volume, zone {}", zone.zone));
    ZoneFilling filling = fill_zone_in_child(zone.problem, fault_of(zone.zone), _input.tasks, seconds);
    parallel::add_task_cpu(filling.cpu_seconds);
    parallel::note_child_memory(filling.child_peak_bytes);
    parallel::log_verbose(fmt::format(
        "volume: zone {}: {} points and {} triangles known, {} tetrahedra of its own, {:.3g} CPU s",
        zone.zone, zone.problem.points.size(), zone.problem.triangles.size(), filling.owned.cells.size(),
        filling.cpu_seconds));
    if (filling.filled && !filling.owned.missing_borders.empty()) {
      for (const std::int32_t t : filling.owned.missing_borders)
        _demoted.push_back({zone.border_leaves[t], zone.zone});
      return 0;
    }
    if (filling.filled) {
      parallel::add_pieces(1);
      const ZoneResult& made = _results[zone.zone] = make_pieces(zone, filling, _input.surface_numbers);
      std::int64_t bytes = 0;
      for (const mesh::Piece& piece : made.pieces) bytes += mesh::bytes_at_rest(piece);
      parallel::note_task({parallel::TaskKind::zone, zone.zone, _work.at(zone.zone),
                           parallel::cpu_seconds() - begin + filling.cpu_seconds, bytes,
                           filling.child_peak_bytes});
      return static_cast<std::int64_t>(filling.owned.cells.size());
    }
    _failures.push_back({zone.zone, filling.failure});
    _diagnostics.note(zone, filling.failure,
                      _retries.changes_of(zone.zone) == 0 ? FailureDiagnostics::Look::later
                                                          : FailureDiagnostics::Look::for_defects);
    return 0;
  }

  void require_size(const ZoneInput& zone) const {
    const std::int64_t predicted = predict_tetrahedra(zone.problem);
    if (predicted <= _input.options.largest_zone) return;
    throw std::runtime_error(fmt::format(
        "a zone would get {} tetrahedra, more than {}. Ask for smaller pieces (VolumeOptions::piece_tets) "
        "or larger elements (SizingOptions::minimum).",
        predicted, _input.options.largest_zone));
  }

  parallel::Fault fault_of(ZoneIndex zone) const {
    const bool is_faulty = _fault.number < 0 || (zone == _fault.number && !_retries.is_merged(zone));
    return is_faulty ? _fault.fault : parallel::Fault::none;
  }

  // --- the mesh

  void note_overlap() {
    const auto there = _communicator.sum(static_cast<std::int64_t>(_shell.local.points.points.size()));
    _report.overlap = static_cast<double>(_communicator.sum(_halo_points)) /
                      static_cast<double>(std::max<std::int64_t>(1, there));
  }

  /// The relative error that 90 % of the zones' expected loads stay below.
  double load_error() const {
    std::vector<double> mine;
    for (const auto& [zone, result] : _results) {
      mine.push_back(std::abs(
          _shell.expected[zone] / static_cast<double>(std::max<std::int64_t>(1, result.tetrahedra)) - 1));
    }
    std::vector<double> errors = _communicator.gather_sorted(mine);
    return errors.empty() ? 0 : errors[(errors.size() - 1) * 9 / 10];
  }

  mesh::DistributedMesh assemble() {
    _report.load_error_90 = load_error();
    CoreMesh core = make_core(_lattice, _shell, _results);
    _report.tetrahedra = core.tetrahedra;
    _report.core_tetrahedra = _communicator.sum(core.tetrahedra);
    for (const auto& [zone, result] : _results) {
      _report.tetrahedra += result.tetrahedra;
      _report.steiner_points += result.steiner_points;
    }
    mesh::DistributedMesh mesh =
        assemble_mesh(_input.surface, _results, std::move(core.pieces), _shell.zones.count());
    _report.tetrahedra = _communicator.sum(_report.tetrahedra);
    _report.steiner_points = _communicator.sum(_report.steiner_points);
    return mesh;
  }

  const parallel::Communicator& _communicator;
  const VolumeInput& _input;
  const Lattice& _lattice;
  Shell& _shell;
  VolumeReport& _report;
  RetryPolicy _retries;
  FillingBudget _budget;
  std::int64_t _halo_points = 0;             // lattice points of this rank's zones
  std::map<ZoneIndex, ZoneResult> _results;  // of this rank
  parallel::FaultRequest _fault = parallel::requested_fault("zone");
  std::map<ZoneIndex, double> _work;   // by which zones were scheduled
  std::vector<ZoneFailure> _failures;  // of this rank in this round
  std::vector<DemotedLeaf> _demoted;   // of this rank in this round
  FailureDiagnostics _diagnostics{_input.surface};
};

}  // namespace

mesh::DistributedMesh fill_zones(const VolumeInput& input, Decomposition decomposition,
                                 VolumeReport& report) {
  Decomposition::Data& data = decomposition.data();
  return ZoneFiller(input, *data.lattice, data.shell, report).run(std::move(data.plan));
}

}  // namespace aeroloom::volume
