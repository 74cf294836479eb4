#include "parallel/collective_error.hpp"
#include "parallel/crash_note.hpp"
#include "parallel/log.hpp"
#include "parallel/progress.hpp"
#include "volume/agreement.hpp"
#include "volume/core_pieces.hpp"
#include "volume/decomposition_data.hpp"
#include "volume/evidence.hpp"
#include "volume/filling_limits.hpp"
#include "volume/zone_piece.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {
namespace {

using parallel::ScopedCpu;

/// Rounds in which leaves are given away where zones disagree; after that such zones are merged.
constexpr int most_rounds_of_giving = 3;

/// Fills zones until all are filled and fit together.
class ZoneFiller {
public:
  ZoneFiller(const parallel::Communicator& communicator, const VolumeInput& input, Decomposition::Data& data,
             parallel::StageClock& clock, VolumeReport& report)
      : _communicator(communicator),
        _input(input),
        _data(data),
        _clock(clock),
        _report(report),
        _finder(*data.frame, *data.tree, *data.zones, input.numbering.vertex_count),
        _changes_of(data.zones->count(), 0),
        _merged(data.zones->count(), 0) {}

  mesh::DistributedMesh run() {
    fill(std::move(_data.plan));
    _report.overlap = static_cast<double>(_communicator.sum(_known_points)) /
                      static_cast<double>(std::max<std::int64_t>(1, _data.report.shell_points));
    for (_report.rounds = 1;; ++_report.rounds) {
      std::vector<ZoneIndex> pending = change_failed();
      if (pending.empty()) pending = settle_disputes();
      if (pending.empty()) return assemble();
      _budget.spend(pending.size(), _report.rounds, _input.options.halo);
      fill(plan(pending));
    }
  }

private:
  // --- one round of filling

  void fill(ZonePlan plan) {
    for (const ZoneLoad& load : plan.loads) _results.erase(load.zone);
    constexpr std::int64_t steps = 1000;  // of a wave, whatever its zones
    parallel::Progress progress("volume", steps * static_cast<std::int64_t>(plan.wants.size()), "tetrahedra");
    std::int64_t waves = 0, made = 0;
    for (const std::vector<ZoneWant>& wants : plan.wants) {
      std::vector<ZoneContent> contents = supply_zones(_communicator, _data.tables(), _data.store(), _finder,
                                                       _data.shares, plan.widths, wants, _clock);
      parallel::agree(_communicator, [&] {
        for (std::size_t i = 0; i < contents.size(); contents[i++] = {}) {
          made += fill_one(contents[i]);
          progress.reach(waves * steps + static_cast<std::int64_t>((i + 1) * steps / contents.size()), made);
        }
      });
      progress.reach(++waves * steps, made);
    }
  }

  ZonePlan plan(const std::vector<ZoneIndex>& pending) {
    std::vector<double> widths;
    for (const int changes : _changes_of) widths.push_back(_input.options.halo * std::pow(wider, changes));
    return plan_zones(_communicator, _data.tables(), pending, widths, _clock);
  }

  /// Tetrahedra made.
  std::int64_t fill_one(ZoneContent& content) {
    const ScopedCpu task(_clock, ScopedCpu::As::task);
    const double begin = parallel::cpu_seconds(), seconds = _input.options.base_cpu_seconds;
    require_size(content);
    _known_points += static_cast<std::int64_t>(content.problem.regions.size());
    const parallel::CrashNote note(fmt::format("stage volume, zone {}", content.zone));
    ZoneFilling filling = fill_zone(content.problem, sabotage_of(content.zone), _input.tasks, seconds);
    _clock.add_task_cpu(filling.cpu_seconds);
    _clock.note_child_memory(filling.child_peak_bytes);
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
      _clock.add_pieces(1);
      const ZoneResult& made = _results[content.zone] = make_pieces(content, filling, _finder);
      std::int64_t bytes = 0;
      for (const mesh::Piece& piece : made.pieces) bytes += mesh::bytes_at_rest(piece);
      _clock.note_task({"zone", content.zone, static_cast<double>(predict_tetrahedra(content.problem)),
                        parallel::cpu_seconds() - begin + filling.cpu_seconds, bytes,
                        filling.child_peak_bytes});
      return static_cast<std::int64_t>(filling.owned.cells.size());
    }
    _failures.push_back({content.zone, filling.failure});
    _evidence.note(content, _input.surface, filling.failure,
                   _changes_of[content.zone] == 0 ? Evidence::Look::later : Evidence::Look::for_defects);
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

  parallel::Sabotage sabotage_of(ZoneIndex zone) const {
    const std::int64_t struck = _input.options.sabotaged_zone;
    const bool strikes = struck < 0 || (zone == struck && !_merged[zone]);
    return strikes ? _input.options.sabotage : parallel::Sabotage::none;
  }

  // --- the ladder

  /// Changes what the zones that failed are made of; returns those to be filled again.
  std::vector<ZoneIndex> change_failed() {
    const std::vector<ZoneFailure> failures = gather_failures(_communicator, std::exchange(_failures, {}));
    const std::vector<LeavingLeaf> leaving =
        _communicator.all_gather_items<LeavingLeaf>(std::exchange(_leaving, {}));
    if (failures.empty() && leaving.empty()) return {};
    if (!failures.empty()) _evidence.stop_at_defects(_communicator);
    std::vector<std::uint8_t> touched(_data.tree->block_count(), 0);
    std::vector<ZoneIndex> pending;
    bool points_change = !leaving.empty();
    for (const auto& [number, zone] : leaving) {
      const Leaf leaf = leaf_of_number(number);
      touched[leaf.block] = 1;
      std::uint8_t& shell = _data.changes[leaf.block].shell;
      _report.left_core += 1 - (shell >> leaf.child & 1);
      shell |= static_cast<std::uint8_t>(1U << leaf.child);
      pending.push_back(zone);
    }
    for (const ZoneFailure& failure : failures) {
      const BlocksOfZones blocks = list_blocks(*_data.tree, *_data.zones);
      const std::span<const BlockIndex> own = blocks.of(failure.zone);
      if (own.empty()) continue;  // merged with one that failed before it
      pending.push_back(failure.zone);
      int& changes = _changes_of[failure.zone];
      std::string change;
      if (changes < std::min<int>(_input.options.retries, std::size(ladder))) {
        const Rung& rung = ladder[changes++];
        change = rung.name;
        for (const BlockIndex b : own) {
          if (!rung.other_points) break;
          touched[b] = 1;
          ++_data.changes[b].variant;
          _data.changes[b].farther = rung.farther;
        }
        points_change = points_change || rung.other_points;
      } else {
        const ZoneIndex with = widest_neighbour(failure.zone, own);
        if (with == no_zone) _evidence.give_up(_communicator, failure.zone, _report.retries);
        change = fmt::format("merged with zone {}", with);
        for (const BlockIndex b : own) touched[b] = 1;
        merge(failure.zone, with);
        pending.push_back(std::min(failure.zone, with));
      }
      parallel::log_info(fmt::format("volume: zone {}: {}: {}", failure.zone, change,
                                     failure.reason.substr(0, failure.reason.find('\n'))));
      _report.retries.push_back({failure.zone, change, failure.reason});
    }
    if (points_change) {
      for (const BlockIndex b : make_all_points(_communicator, _input, _data, _clock)) touched[b] = 1;
    }
    add_those_that_see(touched, pending);
    return pending;
  }

  /// The zone with most blocks beside those of this one; none in a volume of one zone.
  ZoneIndex widest_neighbour(ZoneIndex zone, std::span<const BlockIndex> own) const {
    std::vector<std::int32_t> beside(_data.zones->count(), 0);
    for (const BlockIndex b : own) {
      _data.tree->for_each_block_in(GridBox::of(_data.tree->cube(b)).dilated(0.5), [&](BlockIndex n) {
        const ZoneIndex z = _data.zones->of(n, 0);
        if (z != zone && (_data.counts[n] > 0 || _data.table.is_met(n))) ++beside[z];
      });
    }
    const auto most = std::max_element(beside.begin(), beside.end());
    return most == beside.end() || *most == 0 ? no_zone : static_cast<ZoneIndex>(most - beside.begin());
  }

  void merge(ZoneIndex a, ZoneIndex b) {
    const ZoneIndex low = std::min(a, b), high = std::max(a, b);
    _data.zones->merge(high, low);
    _results.erase(high);
    _merged[low] = _merged[high] = 1;
    _changes_of[low] = 0;
    _data.expected[low] += _data.expected[high];
  }

  /// Adds the zones that know leaves of the touched blocks, sorts, each once; those without blocks go.
  void add_those_that_see(const std::vector<std::uint8_t>& touched, std::vector<ZoneIndex>& pending) {
    const LatticeTree& tree = *_data.tree;
    int most = 0;
    for (const int changes : _changes_of) most = std::max(most, changes);
    const double width = _input.options.halo * std::pow(wider, most);
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (!touched[b]) continue;
      const double reach =
          _data.frame->grid_distance(width * largest_size_around(*_data.frame, tree, _data.table, b));
      tree.for_each_block_in(GridBox::of(tree.cube(b)).dilated(reach), [&](BlockIndex n) {
        for (int child = 0; child < tree.leaf_count(n); ++child) {
          const ZoneIndex z = _data.zones->of(n, child);
          if (pending.empty() || pending.back() != z) pending.push_back(z);
        }
      });
    }
    std::sort(pending.begin(), pending.end());
    pending.erase(std::unique(pending.begin(), pending.end()), pending.end());
    const BlocksOfZones blocks = list_blocks(tree, *_data.zones);
    std::erase_if(pending, [&](ZoneIndex z) { return blocks.of(z).empty(); });
  }

  // --- agreement

  /// Where zones disagree the lowest gets the leaves; returns the zones to be filled again.
  std::vector<ZoneIndex> settle_disputes() {
    std::vector<ZoneFace> faces;
    for (const auto& [zone, result] : _results)
      faces.insert(faces.end(), result.faces.begin(), result.faces.end());
    const std::vector<ZoneFace> unmatched = find_unmatched(_communicator, faces, _clock);
    if (unmatched.empty()) return {};
    ++_rounds_of_giving;
    std::vector<std::uint8_t> touched(_data.tree->block_count(), 0);
    std::vector<ZoneIndex> pending;
    for (const DisputedPlace& place : find_places(unmatched)) {
      const ZoneIndex lowest = place.zones.front();
      const geometry::Vec3 where = middle_of(place, lowest);
      _report.disagreements.push_back({where, lowest, place.faces, _rounds_of_giving});
      parallel::log_verbose(fmt::format("volume: {} faces of {} zones differ around ({:.6g}, {:.6g}, {:.6g})",
                                        place.faces, place.zones.size(), where.x, where.y, where.z));
      pending.insert(pending.end(), place.zones.begin(), place.zones.end());
      if (_rounds_of_giving <= most_rounds_of_giving) {
        give(place, lowest, touched);
      } else if (!merge_all(zones_around(place), touched)) {
        throw_dispute(where);
      }
    }
    add_those_that_see(touched, pending);
    return pending;
  }

  /// The zones that claim faces at a place or have leaves around it.
  std::vector<ZoneIndex> zones_around(const DisputedPlace& place) const {
    std::vector<ZoneIndex> zones = place.zones;
    for_each_leaf_around(place, 2,
                         [&](BlockIndex b, int child) { zones.push_back(_data.zones->of(b, child)); });
    std::sort(zones.begin(), zones.end());
    zones.erase(std::unique(zones.begin(), zones.end()), zones.end());
    return zones;
  }

  /// Makes one zone of several, some of which another place may have merged before. False: they were one
  /// already.
  bool merge_all(const std::vector<ZoneIndex>& zones, std::vector<std::uint8_t>& touched) {
    const BlocksOfZones blocks = list_blocks(*_data.tree, *_data.zones);
    std::vector<ZoneIndex> left;
    for (const ZoneIndex z : zones) {
      if (!blocks.of(z).empty()) left.push_back(z);
      for (const BlockIndex b : blocks.of(z)) touched[b] = 1;
    }
    for (const ZoneIndex z : left) {
      if (z != left.front()) merge(left.front(), z);
    }
    return left.size() > 1 || zones.size() > left.size();
  }

  [[noreturn]] void throw_dispute(geometry::Vec3 where) const {
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format(
            "the tetrahedra around ({:.6g}, {:.6g}, {:.6g}) fit together in no way that was tried. Use other "
            "sizes there, or another piece size (VolumeOptions::piece_tets)",
            where.x, where.y, where.z));
  }

  /// The middle of a place's first leaf; of the zone's, where none of the vertices there has one.
  geometry::Vec3 middle_of(const DisputedPlace& place, ZoneIndex zone) const {
    Leaf leaf{0, 0};
    if (!place.leaves.empty()) {
      leaf = leaf_of_number(place.leaves.front());
    } else if (const BlocksOfZones blocks = list_blocks(*_data.tree, *_data.zones);
               !blocks.of(zone).empty()) {
      leaf.block = blocks.of(zone).front();
    }
    const GridBox box = GridBox::of(_data.tree->leaf(leaf));
    return _data.frame->to_space(0.5 * (box.low + box.high));
  }

  /// Calls visit(block, child) for the leaves of a place and those less than `rings` leaves away from one.
  template <class Visit>
  void for_each_leaf_around(const DisputedPlace& place, int rings, const Visit& visit) const {
    const LatticeTree& tree = *_data.tree;
    for (const LeafNumber number : place.leaves) {
      const Leaf leaf = leaf_of_number(number);
      if (rings == 0) {
        visit(leaf.block, leaf.child);
        continue;
      }
      const GridCube cube = tree.leaf(leaf);
      const GridBox box = GridBox::of(cube).dilated((rings - 0.5) * cube.edge());
      tree.for_each_block_in(box, [&](BlockIndex n) {
        for (int c = 0; c < tree.leaf_count(n); ++c) {
          if (GridBox::of(tree.leaf(n, c)).overlaps(box)) visit(n, c);
        }
      });
    }
  }

  /// The leaves of a place, from the second round on with more and more of those around them.
  void give(const DisputedPlace& place, ZoneIndex to, std::vector<std::uint8_t>& touched) {
    for_each_leaf_around(place, _rounds_of_giving - 1, [&](BlockIndex b, int child) {
      touched[b] = 1;
      _data.zones->give(b, child, to);
    });
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
    CoreMesh core = make_core(
        _communicator,
        {lattice, *_data.core, *_data.squares, _data.shell, *_data.zones, _finder, _data.core_piece_tets},
        _results, _clock);
    _report.tetrahedra = core.tetrahedra;
    _report.core_tetrahedra = _communicator.sum(core.tetrahedra);
    for (const auto& [zone, result] : _results) {
      _report.tetrahedra += result.tetrahedra;
      _report.steiner_points += result.steiner_points;
    }
    mesh::DistributedMesh mesh =
        assemble_mesh(_communicator, _input.surface, _results, std::move(core.pieces), _data.zones->count());
    _report.tetrahedra = _communicator.sum(_report.tetrahedra);
    _report.steiner_points = _communicator.sum(_report.steiner_points);
    return mesh;
  }

  const parallel::Communicator& _communicator;
  const VolumeInput& _input;
  Decomposition::Data& _data;
  parallel::StageClock& _clock;
  VolumeReport& _report;
  ZoneFinder _finder;
  std::vector<int> _changes_of;  // per zone: rungs climbed since it was merged last
  std::vector<std::uint8_t> _merged;
  int _rounds_of_giving = 0;
  FillingBudget _budget{_changes_of.size()};
  std::int64_t _known_points = 0;            // of the lattice, by this rank's zones
  std::map<ZoneIndex, ZoneResult> _results;  // of this rank
  std::vector<ZoneFailure> _failures;        // of this rank in this round
  std::vector<LeavingLeaf> _leaving;         // as well
  Evidence _evidence;
};

}  // namespace

mesh::DistributedMesh fill_zones(const parallel::Communicator& communicator, const VolumeInput& input,
                                 Decomposition decomposition, parallel::StageClock& clock,
                                 VolumeReport& report) {
  register_volume_tasks();  // where the host program has not; too late where it runs a server without them
  return ZoneFiller(communicator, input, decomposition.data(), clock, report).run();
}

}  // namespace aeroloom::volume
