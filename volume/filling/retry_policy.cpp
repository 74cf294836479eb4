#include "volume/filling/retry_policy.hpp"

#include "geometry/place_text.hpp"
#include "geometry/sort_unique.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "volume/zones/halo.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// Rounds that reassign leaves where zones disagree. Later rounds merge the zones. Chosen, not measured.
constexpr int most_rounds_of_reassignment = 3;

}  // namespace

struct RetryPolicy::LeafOfPlace {
  std::int32_t place;
  ZoneIndex zone;  ///< that owns the leaf
  LeafNumber leaf;
  GridBox box;
};

std::vector<double> RetryPolicy::widths() const {
  std::vector<double> widths;
  for (const int changes : _changes_of) widths.push_back(_options.halo * std::pow(wider, changes));
  return widths;
}

RetryPolicy::Changed RetryPolicy::nothing() const {
  return {std::vector<std::uint8_t>(_tree.last() - _tree.first(), 0), {}};
}

// --- zones that failed

std::vector<ZoneIndex> RetryPolicy::change_failed(const std::vector<ZoneFailure>& failures,
                                                  const std::vector<DemotedLeaf>& demoted,
                                                  const FailureDiagnostics& diagnostics) {
  const std::vector<ZoneFailure> failed = diagnostics.gather(failures);
  const std::vector<DemotedLeaf> leaves = _communicator.all_gather_items<DemotedLeaf>(demoted);
  if (failed.empty() && leaves.empty()) return {};
  if (!failed.empty()) diagnostics.stop_at_defects();
  Changed changed = nothing();
  BlockChanges changes = _shell.local.changes;
  demote(leaves, changes, changed);
  bool points_change = !leaves.empty();
  for (const ZoneFailure& failure : failed) {
    if (!is_gone(failure.zone))
      points_change = escalate(failure, diagnostics, changes, changed) || points_change;
  }
  if (points_change) make_points(std::move(changes), changed);
  return zones_reached(std::move(changed));
}

void RetryPolicy::demote(const std::vector<DemotedLeaf>& demoted, BlockChanges& changes, Changed& changed) {
  std::vector<LeafNumber> leaves;
  for (const auto& [number, zone] : demoted) {
    leaves.push_back(number);
    changed.zones.push_back(zone);
  }
  geometry::sort_unique(leaves);
  _report.left_core += static_cast<std::int64_t>(leaves.size());
  for (const LeafNumber number : leaves) {
    if (!_tree.has(number / 8)) continue;
    const Leaf leaf = _tree.leaf_of(number);
    if (_tree.is_own(leaf.block)) changed.blocks[leaf.block - _tree.first()] = 1;
    changes[leaf.block].shell |= static_cast<std::uint8_t>(1U << leaf.child);
  }
}

/// Applies the next remedy to a zone. Returns whether points change.
bool RetryPolicy::escalate(const ZoneFailure& failure, const FailureDiagnostics& diagnostics,
                           BlockChanges& changes, Changed& changed) {
  const ZoneIndex zone = failure.zone;
  changed.zones.push_back(zone);
  bool points_change = false;
  std::string change;
  if (_changes_of[zone] < std::min<int>(_options.retries, std::size(retry_steps))) {
    const RetryStep& step = retry_steps[_changes_of[zone]++];
    change = step.name;
    points_change = step.other_points;
    if (points_change) {
      touch_all(zone, changed);
      for (BlockIndex b = 0; b < _tree.block_count(); ++b) {
        if (!_shell.zones.has(zone, b)) continue;
        ++changes[b].variant;
        changes[b].farther = step.farther;
      }
    }
  } else {
    const ZoneIndex with = widest_neighbour(zone);
    if (with == no_zone) diagnostics.give_up(zone, _report.retries);
    change = fmt::format("merged with zone {}", with);
    touch_all(zone, changed);
    merge(zone, with);
    changed.zones.push_back(std::min(zone, with));
  }
  parallel::log_info(fmt::format("volume: zone {}: {}: {}", zone, change,
                                 failure.reason.substr(0, failure.reason.find('\n'))));
  _report.retries.push_back({zone, change, failure.reason});
  return points_change;
}

/// Makes the points anew, and marks the blocks whose core leaves changed. Collective.
void RetryPolicy::make_points(BlockChanges changes, Changed& changed) {
  LocalShell made = make_local_shell(_lattice, gather_local_surface(_lattice), std::move(changes));
  for (const BlockIndex b : made.core.blocks_unlike(_shell.local.core)) changed.blocks[b - _tree.first()] = 1;
  _shell.local = std::move(made);
}

/// The zone with most blocks next to blocks of this one; no_zone if there is no other. Collective.
ZoneIndex RetryPolicy::widest_neighbour(ZoneIndex zone) const {
  std::vector<std::int64_t> counts(_shell.zones.count(), 0);
  for (BlockIndex b = _tree.first(); b < _tree.last(); ++b) {
    const ZoneIndex z = _shell.zones.of(b, 0);
    if (z == zone || (_shell.local.points.count(b) == 0 && !_lattice.table.is_met(b))) continue;
    _tree.for_each_block_in(GridBox::of(_tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
      if (_shell.zones.has(zone, n)) ++counts[z];
    });
  }
  counts = _shell.zones.sum(std::move(counts));
  const auto most = std::max_element(counts.begin(), counts.end());
  return *most == 0 ? no_zone : static_cast<ZoneIndex>(most - counts.begin());
}

void RetryPolicy::merge(ZoneIndex a, ZoneIndex b) {
  const ZoneIndex low = std::min(a, b), high = std::max(a, b);
  _shell.zones.merge(high, low);
  _is_gone[high] = 1;
  _merged[low] = _merged[high] = 1;
  _changes_of[low] = 0;
  _shell.expected[low] += _shell.expected[high];
}

void RetryPolicy::touch_all(ZoneIndex zone, Changed& changed) const {
  for (BlockIndex b = _tree.first(); b < _tree.last(); ++b) {
    if (_shell.zones.has(zone, b)) changed.blocks[b - _tree.first()] = 1;
  }
}

/// The zones that changed, and those with a halo in changed blocks, ascending. Collective.
std::vector<ZoneIndex> RetryPolicy::zones_reached(Changed changed) {
  std::vector<double> widest = widths();
  widest.assign(widest.size(), *std::max_element(widest.begin(), widest.end()));
  ZonesAround around(_lattice, _shell.zones, widest);
  for (BlockIndex b = _tree.first(); b < _tree.last(); ++b) {
    if (!changed.blocks[b - _tree.first()]) continue;
    around.move_to(b);
    for (const HaloZone& halo : around.zones()) changed.zones.push_back(halo.zone);
  }
  geometry::sort_unique(changed.zones);
  changed.zones = _communicator.all_gather_items<ZoneIndex>(changed.zones);
  geometry::sort_unique(changed.zones);
  std::erase_if(changed.zones, [&](ZoneIndex z) { return is_gone(z); });
  return std::move(changed.zones);
}

// --- zones that disagree

std::vector<ZoneIndex> RetryPolicy::resolve_disputes(std::span<const ZoneFace> faces) {
  const std::vector<ZoneFace> unmatched = find_unmatched(_communicator, faces);
  if (unmatched.empty()) return {};
  ++_rounds_of_reassignment;
  Changed changed = nothing();
  std::vector<DisputedPlace> places = find_places(unmatched);
  for (DisputedPlace& place : places) {
    changed.zones.insert(changed.zones.end(), place.zones.begin(), place.zones.end());
    if (place.leaves.empty()) place.leaves.push_back(lowest_leaf(place.zones.front()));
  }
  note_places(places);
  if (_rounds_of_reassignment <= most_rounds_of_reassignment)
    reassign(places, changed);
  else
    merge_around(places, changed);
  return zones_reached(std::move(changed));
}

/// The lowest leaf of a zone, for places where TetGen added all the vertices. Collective.
LeafNumber RetryPolicy::lowest_leaf(ZoneIndex zone) const {
  std::int64_t lowest = INT64_MAX;
  for (BlockIndex b = _tree.last(); b-- > _tree.first();) {
    for (int child = _tree.leaf_count(b); child-- > 0;) {
      if (_shell.zones.of(b, child) == zone) lowest = _tree.number(Leaf{b, child});
    }
  }
  lowest = _communicator.minimum(lowest);
  return lowest == INT64_MAX ? 0 : lowest;
}

/// The leaves of places and those less than `rings` leaves away, by place. Collective.
std::vector<RetryPolicy::LeafOfPlace> RetryPolicy::leaves_around(std::span<const DisputedPlace> places,
                                                                 int rings) const {
  std::vector<LeafOfPlace> found;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const LeafNumber number : places[i].leaves) {
      if (_tree.owner(number / 8) != _communicator.rank()) continue;
      const Leaf leaf = _tree.leaf_of(number);
      found.push_back({static_cast<std::int32_t>(i), _shell.zones.of(leaf.block, leaf.child), number,
                       GridBox::of(_tree.leaf(leaf))});
    }
  }
  const auto in_order = [](const LeafOfPlace& a, const LeafOfPlace& b) {
    return std::tie(a.place, a.leaf) < std::tie(b.place, b.leaf);
  };
  found = _communicator.all_gather_items<LeafOfPlace>(found);
  std::sort(found.begin(), found.end(), in_order);
  if (rings == 0) return found;
  std::vector<LeafOfPlace> around;
  for (const LeafOfPlace& center : found) {
    const GridBox box = center.box.dilated((rings - 0.5) * (center.box.high.x - center.box.low.x));
    _tree.for_each_own_block_in(box, [&](BlockIndex n) {
      for (int child = 0; child < _tree.leaf_count(n); ++child) {
        const GridBox leaf = GridBox::of(_tree.leaf(n, child));
        if (leaf.overlaps(box))
          around.push_back({center.place, _shell.zones.of(n, child), _tree.number(Leaf{n, child}), leaf});
      }
    });
  }
  around = _communicator.all_gather_items<LeafOfPlace>(around);
  geometry::sort_unique(around, in_order, [](const LeafOfPlace& a, const LeafOfPlace& b) {
    return a.place == b.place && a.leaf == b.leaf;
  });
  return around;
}

/// Reports each place by the middle of its first leaf. Collective.
void RetryPolicy::note_places(std::span<const DisputedPlace> places) {
  std::int32_t next = 0;
  for (const LeafOfPlace& leaf : leaves_around(places, 0)) {
    if (leaf.place != next) continue;
    const DisputedPlace& place = places[next++];
    const Vec3 where = _lattice.frame.to_space(0.5 * (leaf.box.low + leaf.box.high));
    _report.disagreements.push_back({where, place.zones.front(), place.faces, _rounds_of_reassignment});
    parallel::log_verbose(fmt::format("volume: {} faces of {} zones differ around {}", place.faces,
                                      place.zones.size(), geometry::place_text(where)));
  }
}

/// Reassigns the leaves of places, in later rounds with rings of leaves around them. Collective.
void RetryPolicy::reassign(std::span<const DisputedPlace> places, Changed& changed) {
  for (const LeafOfPlace& leaf : leaves_around(places, _rounds_of_reassignment - 1)) {
    const BlockNumber block = leaf.leaf / 8;
    if (_tree.owner(block) == _communicator.rank()) changed.blocks[_tree.index(block) - _tree.first()] = 1;
    _shell.zones.reassign(
        {block, static_cast<int>(leaf.leaf % 8), leaf.box, places[leaf.place].zones.front()});
  }
}

/// Merges all zones that have faces at a place or leaves around it. Collective.
void RetryPolicy::merge_around(std::span<const DisputedPlace> places, Changed& changed) {
  std::vector<std::vector<ZoneIndex>> zones;
  for (const DisputedPlace& place : places) zones.push_back(place.zones);
  for (const LeafOfPlace& leaf : leaves_around(places, 2)) zones[leaf.place].push_back(leaf.zone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    geometry::sort_unique(zones[i]);
    std::vector<ZoneIndex> remaining = zones[i];  // another place may have merged some of them
    std::erase_if(remaining, [&](ZoneIndex z) { return is_gone(z); });
    if (remaining.size() == zones[i].size() && remaining.size() < 2) {
      const Vec3 where = _report.disagreements[_report.disagreements.size() - places.size() + i].place;
      throw parallel::CollectiveError(
          parallel::FailureKind::input,
          fmt::format("the tetrahedra around {} fit together in no way that was tried. Use other sizes "
                      "there, or another piece size (VolumeOptions::piece_tets)",
                      geometry::place_text(where)));
    }
    for (const ZoneIndex z : remaining) touch_all(z, changed);
    for (const ZoneIndex z : remaining) {
      if (z != remaining.front()) merge(remaining.front(), z);
    }
  }
}

}  // namespace aeroloom::volume
