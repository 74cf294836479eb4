#include "volume/agreement.hpp"
#include "volume/decomposition_parts.hpp"
#include "volume/failure.hpp"
#include "volume/zone_piece.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "parallel/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::volume {
namespace {

using parallel::ScopedCpu;

/// Zones that a rank is sent at a time.
constexpr std::size_t zones_at_a_time = 4;
/// Changes that a zone which cannot be filled gets before it is merged.
constexpr int most_changes = 2;
/// What the halo grows by with each of them.
constexpr double wider = 1.5;
/// Rounds in which leaves are given away where zones disagree; after that such zones are merged.
constexpr int most_rounds_of_giving = 3;

/// Expected work on a zone.
struct ZoneLoad {
  ZoneIndex zone;
  float points;     ///< of the lattice, halo included
  float triangles;  ///< halo included

  double work() const { return tetrahedra_per_point * points + tetrahedra_per_triangle * triangles; }
};

/// Why a zone was not filled.
struct ZoneFailure {
  ZoneIndex zone;
  std::string reason;
};

/// Fills zones until all are filled and fit together.
class ZoneFiller {
public:
  ZoneFiller(const parallel::Communicator& communicator, const VolumeInput& input, Decomposition::Parts& parts,
             parallel::StageClock& clock, VolumeReport& report)
      : _communicator(communicator),
        _input(input),
        _parts(parts),
        _clock(clock),
        _report(report),
        _finder(*parts.frame, *parts.tree, *parts.zones, input.numbering.vertex_count),
        _changes_of(parts.zones->count(), 0),
        _merged(parts.zones->count(), 0) {}

  mesh::DistributedMesh run() {
    std::vector<ZoneIndex> pending;
    for (ZoneIndex z = 0; z < _parts.zones->count(); ++z) pending.push_back(z);
    for (_report.rounds = 0; !pending.empty(); ++_report.rounds) {
      fill(pending);
      pending = change_failed();
      if (pending.empty()) pending = settle_disputes();
    }
    return assemble();
  }

private:
  // --- one round of filling

  void fill(const std::vector<ZoneIndex>& pending) {
    for (const ZoneIndex z : pending) _results.erase(z);
    std::vector<ZoneLoad> loads;
    std::vector<ZoneWant> wants = list_wants(pending, loads);
    std::vector<double> work;
    for (const ZoneLoad& load : loads) work.push_back(load.work());
    const std::vector<parallel::Rank> owners = parallel::assign_largest_first(work, _communicator.size());
    if (_report.rounds == 0) note_loads(loads);

    // Which zones come together: those that are n-th, n + 1-th, ... on their ranks.
    std::vector<std::size_t> batch_of(_parts.zones->count(), 0);
    std::vector<parallel::Rank> rank_of(_parts.zones->count(), 0);
    std::size_t batches = 0;
    for (parallel::Rank r = 0; r < _communicator.size(); ++r) {
      const std::vector<int> tasks = parallel::tasks_of_rank(owners, work, r);
      for (std::size_t i = 0; i < tasks.size(); ++i) {
        const ZoneIndex z = loads[tasks[i]].zone;
        batch_of[z] = i / zones_at_a_time;
        rank_of[z] = r;
        batches = std::max(batches, i / zones_at_a_time + 1);
      }
    }
    for (std::size_t batch = 0; batch < batches; ++batch) {
      std::vector<ZoneWant> now;
      for (ZoneWant& want : wants) {
        if (batch_of[want.zone] != batch) continue;
        want.rank = rank_of[want.zone];
        now.push_back(want);
      }
      std::vector<ZoneContent> contents = bring(now);
      parallel::agree(_communicator, [&] {
        for (ZoneContent& content : contents) {
          fill_one(content);
          content = {};
        }
      });
    }
  }

  std::vector<ZoneContent> bring(const std::vector<ZoneWant>& wants) {
    const ScopedCpu task(_clock, ScopedCpu::As::task);
    return supply_zones(_communicator, {_parts.points, _parts.triangles, *_parts.of_blocks}, *_parts.frame,
                        *_parts.tree, _finder, _parts.shares, wants);
  }

  /// What the zones know; each rank looks at some of them. Loads come for all, in the order of `zones`.
  std::vector<ZoneWant> list_wants(const std::vector<ZoneIndex>& zones, std::vector<ZoneLoad>& loads) {
    std::vector<ZoneWant> wants;
    std::vector<ZoneLoad> mine;
    {
      const ScopedCpu task(_clock, ScopedCpu::As::task);
      const BlocksOfZones blocks = list_blocks(*_parts.tree, *_parts.zones);
      HaloTaker taker(*_parts.frame, *_parts.tree, _parts.table, *_parts.zones);
      const bool whole = _parts.zones->count() == 1;
      for (std::size_t i = _communicator.rank(); i < zones.size(); i += _communicator.size()) {
        const ZoneIndex z = zones[i];
        const double width = _input.options.halo * std::pow(wider, _changes_of[z]);
        ZoneLoad load{z, 0, 0};
        for (const TakenBlock& taken : whole ? take_all(*_parts.tree) : taker.take(z, blocks.of(z), width)) {
          const float part = static_cast<float>(__builtin_popcount(taken.leaves)) / static_cast<float>(_parts.tree->leaf_count(taken.block));
          load.points += part * _parts.counts[taken.block];
          load.triangles += part * static_cast<float>(_parts.table.triangles[taken.block]);
          if (_parts.counts[taken.block] > 0 || _parts.table.is_met(taken.block))
            wants.push_back({z, taken.block, 0, taken.leaves});
        }
        mine.push_back(load);
      }
    }
    loads = _communicator.all_gather_items<ZoneLoad>(mine);
    std::sort(loads.begin(), loads.end(), [](const ZoneLoad& a, const ZoneLoad& b) { return a.zone < b.zone; });
    return wants;
  }

  void note_loads(const std::vector<ZoneLoad>& loads) {
    double points = 0, work = 0, heaviest = 0;
    _expected.assign(loads.size(), 0);
    for (const ZoneLoad& load : loads) {
      points += load.points;
      work += load.work();
      heaviest = std::max(heaviest, load.work());
    }
    _parts.report.halo = points / std::max(1.0, static_cast<double>(_parts.report.lattice_points));
    _parts.report.imbalance = heaviest * static_cast<double>(loads.size()) / std::max(work, 1.0);
  }

  void fill_one(ZoneContent& content) {
    const ScopedCpu task(_clock, ScopedCpu::As::task);
    require_size(content);
    ZoneFilling filling = fill_zone(content.problem, sabotage_of(content.zone));
    _clock.add_task_cpu(filling.cpu_seconds);
    _clock.note_child_memory(filling.child_peak_bytes);
    if (filling.filled) {
      _clock.add_pieces(1);
      _results[content.zone] = make_pieces(content, filling, _finder);
      return;
    }
    _failures.push_back({content.zone, filling.failure});
    _evidence.note(content, _input.surface, filling.failure);
  }

  void require_size(const ZoneContent& content) const {
    const std::int64_t predicted = predict_tetrahedra(content.problem);
    if (predicted <= _input.options.largest_piece) return;
    throw std::runtime_error(fmt::format(
        "a zone would get {} tetrahedra, more than {} (VolumeOptions::largest_piece). Ask for smaller pieces "
        "(volume.piece_tets) or larger elements (sizing.minimum).",
        predicted, _input.options.largest_piece));
  }

  VolumeOptions::Sabotage sabotage_of(ZoneIndex zone) const {
    const std::int64_t struck = _input.options.sabotaged_zone;
    const bool strikes = struck < 0 || (zone == struck && !_merged[zone]);
    return strikes ? _input.options.sabotage : VolumeOptions::Sabotage::none;
  }

  // --- the ladder

  /// Changes what the zones that failed are made of; returns those to be filled again.
  std::vector<ZoneIndex> change_failed() {
    const std::vector<ZoneFailure> failures = gather_failures();
    if (failures.empty()) return {};
    _evidence.stop_at_defects(_communicator);
    std::vector<std::uint8_t> touched(_parts.tree->block_count(), 0);
    std::vector<ZoneIndex> pending;
    bool points_change = false;
    for (const ZoneFailure& failure : failures) {
      const BlocksOfZones blocks = list_blocks(*_parts.tree, *_parts.zones);
      const std::span<const BlockIndex> own = blocks.of(failure.zone);
      if (own.empty()) continue;  // merged with one that failed before it
      for (const BlockIndex b : own) touched[b] = 1;
      pending.push_back(failure.zone);
      int& changes = _changes_of[failure.zone];
      std::string change;
      if (changes < std::min(_input.options.retries, most_changes)) {
        for (const BlockIndex b : own) {
          ++_parts.changes[b].variant;
          _parts.changes[b].farther = static_cast<std::uint8_t>(changes);
        }
        change = changes == 0 ? "other perturbations of its points, a wider halo"
                              : "points farther off the surface, a wider halo";
        ++changes;
        points_change = true;
      } else {
        const ZoneIndex with = widest_neighbour(failure.zone, own);
        if (with == no_zone) _evidence.give_up(_communicator, failure.zone, _report.retries);
        change = fmt::format("merged with zone {}", with);
        merge(failure.zone, with);
        pending.push_back(std::min(failure.zone, with));
      }
      parallel::log_info(fmt::format("volume: zone {}: {}: {}", failure.zone, change,
                                     failure.reason.substr(0, failure.reason.find('\n'))));
      _report.retries.push_back({failure.zone, change, failure.reason});
    }
    if (points_change) make_all_points(_communicator, _input, _parts, _clock);
    add_those_that_see(touched, pending);
    return pending;
  }

  std::vector<ZoneFailure> gather_failures() {
    parallel::Packer packer;
    for (const ZoneFailure& failure : _failures) {
      packer.value(failure.zone);
      packer.text(failure.reason);
    }
    _failures.clear();
    std::vector<ZoneFailure> all;
    for (const parallel::Bytes& bytes : _communicator.all_gather(packer.take())) {
      parallel::Unpacker unpacker(bytes);
      while (!unpacker.at_end()) {
        ZoneFailure& failure = all.emplace_back();
        failure.zone = unpacker.value<ZoneIndex>();
        failure.reason = unpacker.text();
      }
    }
    std::sort(all.begin(), all.end(), [](const ZoneFailure& a, const ZoneFailure& b) { return a.zone < b.zone; });
    return all;
  }

  /// The zone with most blocks beside those of this one; none in a volume of one zone.
  ZoneIndex widest_neighbour(ZoneIndex zone, std::span<const BlockIndex> own) const {
    std::vector<std::int32_t> beside(_parts.zones->count(), 0);
    for (const BlockIndex b : own) {
      _parts.tree->for_each_block_in(GridBox::of(_parts.tree->cell(b)).dilated(0.5), [&](BlockIndex n) {
        const ZoneIndex z = _parts.zones->of(n, 0);
        if (z != zone && (_parts.counts[n] > 0 || _parts.table.is_met(n))) ++beside[z];
      });
    }
    const auto most = std::max_element(beside.begin(), beside.end());
    return most == beside.end() || *most == 0 ? no_zone : static_cast<ZoneIndex>(most - beside.begin());
  }

  void merge(ZoneIndex a, ZoneIndex b) {
    const ZoneIndex low = std::min(a, b), high = std::max(a, b);
    _parts.zones->merge(high, low);
    _results.erase(high);
    _merged[low] = _merged[high] = 1;
    _changes_of[low] = 0;
  }

  /// Adds the zones that may know leaves of the touched blocks, sorts, each once; those without blocks go.
  void add_those_that_see(const std::vector<std::uint8_t>& touched, std::vector<ZoneIndex>& pending) {
    const LatticeTree& tree = *_parts.tree;
    int most = 0;
    for (const int changes : _changes_of) most = std::max(most, changes);
    const double width = 4 * _input.options.halo * std::pow(wider, most);
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (!touched[b]) continue;
      const double size = std::max(_parts.frame->edge(tree.leaf_level(b)), double{_parts.table.longest_edge[b]});
      tree.for_each_block_in(GridBox::of(tree.cell(b)).dilated(_parts.frame->grid_distance(width * size)), [&](BlockIndex n) {
        for (int child = 0; child < tree.leaf_count(n); ++child) {
          const ZoneIndex z = _parts.zones->of(n, child);
          if (pending.empty() || pending.back() != z) pending.push_back(z);
        }
      });
    }
    std::sort(pending.begin(), pending.end());
    pending.erase(std::unique(pending.begin(), pending.end()), pending.end());
    const BlocksOfZones blocks = list_blocks(tree, *_parts.zones);
    std::erase_if(pending, [&](ZoneIndex z) { return blocks.of(z).empty(); });
  }

  // --- agreement

  /// Where zones disagree the lowest gets the leaves; returns the zones to be filled again.
  std::vector<ZoneIndex> settle_disputes() {
    std::vector<ZoneFace> faces;
    for (const auto& [zone, result] : _results) faces.insert(faces.end(), result.faces.begin(), result.faces.end());
    std::vector<ZoneFace> unmatched;
    {
      const ScopedCpu task(_clock, ScopedCpu::As::task);
      unmatched = find_unmatched(_communicator, faces);
    }
    if (unmatched.empty()) return {};
    ++_rounds_of_giving;
    std::vector<std::uint8_t> touched(_parts.tree->block_count(), 0);
    std::vector<ZoneIndex> pending;
    for (const DisputedPlace& place : find_places(unmatched)) {
      const ZoneIndex lowest = place.zones.front();
      const geometry::Vec3 where = place_of(place.leaves.front());
      _report.disagreements.push_back({where, lowest, place.faces, _rounds_of_giving});
      parallel::log_verbose(fmt::format("volume: {} faces of {} zones differ around ({:.6g}, {:.6g}, {:.6g})",
                                        place.faces, place.zones.size(), where.x, where.y, where.z));
      pending.insert(pending.end(), place.zones.begin(), place.zones.end());
      if (_rounds_of_giving > most_rounds_of_giving) {
        if (place.zones.size() == 1) throw_dispute(where);
        const BlocksOfZones blocks = list_blocks(*_parts.tree, *_parts.zones);
        for (const ZoneIndex z : place.zones) {
          for (const BlockIndex b : blocks.of(z)) touched[b] = 1;
          if (z != lowest) merge(lowest, z);
        }
      } else {
        give(place, lowest, touched);
      }
    }
    add_those_that_see(touched, pending);
    return pending;
  }

  [[noreturn]] void throw_dispute(geometry::Vec3 where) const {
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format("the tetrahedra around ({:.6g}, {:.6g}, {:.6g}) do not fit together, in any way that was tried. Use "
                    "other sizes there, or another piece size (volume.piece_tets)",
                    where.x, where.y, where.z));
  }

  geometry::Vec3 place_of(std::int64_t leaf) const {
    const GridBox box = GridBox::of(_parts.tree->leaf(static_cast<BlockIndex>(leaf / 8), static_cast<int>(leaf % 8)));
    return _parts.frame->to_space(0.5 * (box.low + box.high));
  }

  /// The leaves of a place, from the second round on with those around them.
  void give(const DisputedPlace& place, ZoneIndex to, std::vector<std::uint8_t>& touched) {
    const LatticeTree& tree = *_parts.tree;
    for (const std::int64_t leaf : place.leaves) {
      const auto b = static_cast<BlockIndex>(leaf / 8);
      const int child = static_cast<int>(leaf % 8);
      touched[b] = 1;
      _parts.zones->give(b, child, to);
      if (_rounds_of_giving == 1) continue;
      const GridBox box = GridBox::of(tree.leaf(b, child)).dilated(0.5);
      tree.for_each_block_in(box, [&](BlockIndex n) {
        for (int c = 0; c < tree.leaf_count(n); ++c) {
          if (!GridBox::of(tree.leaf(n, c)).overlaps(box)) continue;
          touched[n] = 1;
          _parts.zones->give(n, c, to);
        }
      });
    }
  }

  // --- the mesh

  mesh::DistributedMesh assemble() {
    struct Row {
      ZoneIndex zone;
      mesh::RegionId region;
    };
    std::vector<Row> rows;
    for (const auto& [zone, result] : _results) {
      for (const mesh::Piece& piece : result.pieces) rows.push_back({zone, piece.region});
      _report.steiner_points += result.steiner_points;
    }
    rows = _communicator.all_gather_items<Row>(rows);
    const auto before = [](const Row& a, const Row& b) { return a.zone != b.zone ? a.zone < b.zone : a.region < b.region; };
    std::sort(rows.begin(), rows.end(), before);
    mesh::DistributedMesh mesh;
    mesh.piece_count = static_cast<mesh::PieceId>(rows.size());
    for (auto& [zone, result] : _results) {
      for (mesh::Piece& piece : result.pieces) {
        piece.id = static_cast<mesh::PieceId>(
            std::lower_bound(rows.begin(), rows.end(), Row{zone, piece.region}, before) - rows.begin());
        mesh.pieces.push_back(std::move(piece));
      }
    }
    mesh.patches = _input.surface.patches;
    mesh.faces = _input.surface.faces;
    mesh.regions = _input.surface.regions;
    mesh.sides = _input.surface.sides;
    _report.steiner_points = _communicator.sum(_report.steiner_points);
    return mesh;
  }

  const parallel::Communicator& _communicator;
  const VolumeInput& _input;
  Decomposition::Parts& _parts;
  parallel::StageClock& _clock;
  VolumeReport& _report;
  ZoneFinder _finder;
  std::vector<int> _changes_of;   // per zone: of its points so far
  std::vector<std::uint8_t> _merged;
  std::vector<double> _expected;
  int _rounds_of_giving = 0;
  std::map<ZoneIndex, ZoneResult> _results;  // of this rank
  std::vector<ZoneFailure> _failures;        // of this rank in this round
  Evidence _evidence;
};

}  // namespace

mesh::DistributedMesh fill_zones(const parallel::Communicator& communicator, const VolumeInput& input,
                                 Decomposition decomposition, parallel::StageClock& clock, VolumeReport& report) {
  return ZoneFiller(communicator, input, decomposition.parts(), clock, report).run();
}

}  // namespace aeroloom::volume
