#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/fault.hpp"
#include "volume/filling/core_pieces.hpp"
#include "volume/filling/decomposition_data.hpp"
#include "volume/filling/filling_limits.hpp"
#include "volume/filling/zone_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {
namespace {

using parallel::ScopedCpu;

/// Fills zones until all are filled and fit together.
class ZoneFiller {
public:
  ZoneFiller(const VolumeInput& input, Decomposition::Data& data, VolumeReport& report)
      : _communicator(input.surface.communicator),
        _input(input),
        _data(data),
        _report(report),
        _ladder(input, data, report),
        _budget(data.zones->count()) {}

  mesh::DistributedMesh run() {
    fill(std::move(_data.plan));
    _report.overlap = static_cast<double>(_communicator.sum(_known_points)) /
                      static_cast<double>(std::max<std::int64_t>(1, _data.report.shell_points));
    for (_report.rounds = 1;; ++_report.rounds) {
      std::vector<ZoneIndex> pending =
          _ladder.change_failed(std::exchange(_failures, {}), std::exchange(_leaving, {}), _evidence);
      if (pending.empty()) pending = _ladder.resolve_disputes(faces());
      if (pending.empty()) return assemble();
      _budget.spend(pending.size(), _report.rounds, _input.options.halo);
      fill(plan(pending));
    }
  }

private:
  // --- one round of filling

  void fill(ZonePlan plan) {
    parallel::begin_round();
    for (const ZoneLoad& load : plan.loads) _results.erase(load.zone), _work[load.zone] = load.work();
    std::erase_if(_results, [&](const auto& result) { return _ladder.is_gone(result.first); });
    constexpr std::int64_t steps = 1000;  // of a wave, whatever its zones
    parallel::Progress progress("volume", steps * static_cast<std::int64_t>(plan.batches.size()),
                                "tetrahedra");
    std::int64_t waves = 0, made = 0;
    for (const ZoneShipment& batch : plan.batches) {
      std::vector<ZoneContent> contents = supply_zones(_communicator, _data.store(_input), batch);
      parallel::agree(_communicator, [&] {
        for (std::size_t i = 0; i < contents.size(); contents[i++] = {}) {
          made += fill_one(contents[i]);
          progress.set_done(waves * steps + static_cast<std::int64_t>((i + 1) * steps / contents.size()),
                            made);
        }
      });
      progress.set_done(++waves * steps, made);
    }
  }

  ZonePlan plan(const std::vector<ZoneIndex>& pending) {
    return plan_zones(_communicator, _data.store(_input), pending, _ladder.widths());
  }

  std::vector<ZoneFace> faces() const {
    std::vector<ZoneFace> faces;
    for (const auto& [zone, result] : _results)
      faces.insert(faces.end(), result.faces.begin(), result.faces.end());
    return faces;
  }

  /// Tetrahedra made.
  std::int64_t fill_one(ZoneContent& content) {
    const ScopedCpu task(ScopedCpu::As::task);
    const double begin = parallel::cpu_seconds(), seconds = _input.options.base_cpu_seconds;
    require_size(content);
    _known_points += static_cast<std::int64_t>(content.problem.regions.size());
    const parallel::CrashNote note(fmt::format("stage volume, zone {}", content.zone));
    ZoneFilling filling = fill_zone_in_child(content.problem, fault_of(content.zone), _input.tasks, seconds);
    parallel::add_task_cpu(filling.cpu_seconds);
    parallel::note_child_memory(filling.child_peak_bytes);
    parallel::log_verbose(fmt::format(
        "volume: zone {}: {} points and {} triangles known, {} tetrahedra of its own, {:.3g} CPU s",
        content.zone, content.problem.points.size(), content.problem.triangles.size(),
        filling.owned.cells.size(), filling.cpu_seconds));
    if (filling.filled && !filling.owned.missing_borders.empty()) {
      for (const std::int32_t t : filling.owned.missing_borders)
        _leaving.push_back({content.border_leaves[t], content.zone});
      return 0;
    }
    if (filling.filled) {
      parallel::add_pieces(1);
      const ZoneResult& made = _results[content.zone] = make_pieces(content, filling);
      std::int64_t bytes = 0;
      for (const mesh::Piece& piece : made.pieces) bytes += mesh::bytes_at_rest(piece);
      parallel::note_task({parallel::TaskKind::zone, content.zone, _work.at(content.zone),
                           parallel::cpu_seconds() - begin + filling.cpu_seconds, bytes,
                           filling.child_peak_bytes});
      return static_cast<std::int64_t>(filling.owned.cells.size());
    }
    _failures.push_back({content.zone, filling.failure});
    _evidence.note(
        content, _input.surface, filling.failure,
        _ladder.changes_of(content.zone) == 0 ? Evidence::Look::later : Evidence::Look::for_defects);
    return 0;
  }

  void require_size(const ZoneContent& content) const {
    const std::int64_t predicted = predict_tetrahedra(content.problem);
    if (predicted <= _input.options.largest_zone) return;
    throw std::runtime_error(fmt::format(
        "a zone would get {} tetrahedra, more than {}. Ask for smaller pieces (VolumeOptions::piece_tets) "
        "or larger elements (SizingOptions::minimum).",
        predicted, _input.options.largest_zone));
  }

  parallel::Fault fault_of(ZoneIndex zone) const {
    const bool is_faulty = _fault.number < 0 || (zone == _fault.number && !_ladder.is_merged(zone));
    return is_faulty ? _fault.fault : parallel::Fault::none;
  }

  // --- the mesh

  /// The relative error that 90 % of the zones' expected loads stay below.
  double load_error() const {
    std::vector<double> mine;
    for (const auto& [zone, result] : _results) {
      mine.push_back(std::abs(
          _data.expected[zone] / static_cast<double>(std::max<std::int64_t>(1, result.tetrahedra)) - 1));
    }
    std::vector<double> errors = _communicator.all_gather_items<double>(mine);
    std::sort(errors.begin(), errors.end());
    return errors.empty() ? 0 : errors[(errors.size() - 1) * 9 / 10];
  }

  mesh::DistributedMesh assemble() {
    _report.load_error_90 = load_error();
    const LatticeSource lattice = _data.source(_input);
    CoreMesh core = make_core(_communicator,
                              {lattice, *_data.core, *_data.squares, _data.shell, *_data.zones,
                               _data.finder(_input), _data.core_piece_tets},
                              _results);
    _report.tetrahedra = core.tetrahedra;
    _report.core_tetrahedra = _communicator.sum(core.tetrahedra);
    for (const auto& [zone, result] : _results) {
      _report.tetrahedra += result.tetrahedra;
      _report.steiner_points += result.steiner_points;
    }
    mesh::DistributedMesh mesh =
        assemble_mesh(_input.surface, _results, std::move(core.pieces), _data.zones->count());
    _report.tetrahedra = _communicator.sum(_report.tetrahedra);
    _report.steiner_points = _communicator.sum(_report.steiner_points);
    return mesh;
  }

  const parallel::Communicator& _communicator;
  const VolumeInput& _input;
  Decomposition::Data& _data;
  VolumeReport& _report;
  ZoneLadder _ladder;
  FillingBudget _budget;
  std::int64_t _known_points = 0;            // of the lattice, by this rank's zones
  std::map<ZoneIndex, ZoneResult> _results;  // of this rank
  parallel::FaultRequest _fault = parallel::requested_fault("zone");
  std::map<ZoneIndex, double> _work;   // that zones were scheduled by
  std::vector<ZoneFailure> _failures;  // of this rank in this round
  std::vector<LeavingLeaf> _leaving;   // as well
  Evidence _evidence;
};

}  // namespace

mesh::DistributedMesh fill_zones(const VolumeInput& input, Decomposition decomposition,
                                 VolumeReport& report) {
  return ZoneFiller(input, decomposition.data(), report).run();
}

}  // namespace aeroloom::volume
