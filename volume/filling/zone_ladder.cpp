#include "volume/filling/zone_ladder.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "volume/filling/filling_limits.hpp"
#include "volume/zones/halo.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// Rounds in which leaves are given away where zones disagree; after that such zones are merged. Chosen, not
/// measured.
constexpr int most_rounds_of_giving = 3;

template <class T>
void keep_each_once(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

struct ZoneLadder::LeafOfPlace {
  std::int32_t place;
  ZoneIndex zone;  ///< that has it
  LeafNumber leaf;
  GridBox box;

  static constexpr auto fields() {
    return std::tuple(&LeafOfPlace::place, &LeafOfPlace::zone, &LeafOfPlace::leaf, &LeafOfPlace::box);
  }
};

std::vector<double> ZoneLadder::widths() const {
  std::vector<double> widths;
  for (const int changes : _changes_of) widths.push_back(_input.options.halo * std::pow(wider, changes));
  return widths;
}

ZoneLadder::Changed ZoneLadder::nothing() const {
  return {std::vector<std::uint8_t>(_data.tree->last() - _data.tree->first(), 0), {}};
}

// --- zones that failed

std::vector<ZoneIndex> ZoneLadder::change_failed(const std::vector<ZoneFailure>& failures,
                                                 const std::vector<LeavingLeaf>& leaving,
                                                 const Evidence& evidence) {
  const std::vector<ZoneFailure> failed = gather_failures(_communicator, failures);
  const std::vector<LeavingLeaf> left = _communicator.all_gather_items<LeavingLeaf>(leaving);
  if (failed.empty() && left.empty()) return {};
  if (!failed.empty()) evidence.stop_at_defects(_communicator);
  Changed changed = nothing();
  bool points_change = give_to_shell(left, changed);
  for (const ZoneFailure& failure : failed) {
    if (!is_gone(failure.zone)) points_change = climb(failure, evidence, changed) || points_change;
  }
  if (points_change) {
    for (const BlockIndex b : make_all_points(_input, _data)) changed.blocks[b - _data.tree->first()] = 1;
  }
  return those_that_see(std::move(changed));
}

/// Whether there are any.
bool ZoneLadder::give_to_shell(const std::vector<LeavingLeaf>& leaving, Changed& changed) {
  std::vector<LeafNumber> leaves;
  for (const auto& [number, zone] : leaving) {
    leaves.push_back(number);
    changed.zones.push_back(zone);
  }
  keep_each_once(leaves);
  _report.left_core += static_cast<std::int64_t>(leaves.size());
  for (const LeafNumber number : leaves) {
    if (!_data.tree->knows(number / 8)) continue;
    const Leaf leaf = _data.tree->leaf_of(number);
    if (_data.tree->is_own(leaf.block)) changed.blocks[leaf.block - _data.tree->first()] = 1;
    _data.changes[leaf.block].shell |= static_cast<std::uint8_t>(1U << leaf.child);
  }
  return !leaves.empty();
}

/// Whether points change.
bool ZoneLadder::climb(const ZoneFailure& failure, const Evidence& evidence, Changed& changed) {
  const ZoneIndex zone = failure.zone;
  changed.zones.push_back(zone);
  bool points_change = false;
  std::string change;
  if (_changes_of[zone] < std::min<int>(_input.options.retries, std::size(ladder))) {
    const Rung& rung = ladder[_changes_of[zone]++];
    change = rung.name;
    points_change = rung.other_points;
    if (points_change) {
      touch_all(zone, changed);
      for (BlockIndex b = 0; b < _data.tree->block_count(); ++b) {
        if (!_data.zones->has(zone, b)) continue;
        ++_data.changes[b].variant;
        _data.changes[b].farther = rung.farther;
      }
    }
  } else {
    const ZoneIndex with = widest_neighbour(zone);
    if (with == no_zone) evidence.give_up(_communicator, zone, _report.retries);
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

/// The zone with most blocks beside those of this one; none in a volume of one zone. Collective.
ZoneIndex ZoneLadder::widest_neighbour(ZoneIndex zone) const {
  std::vector<std::int64_t> counts(_data.zones->count(), 0);
  for (BlockIndex b = _data.tree->first(); b < _data.tree->last(); ++b) {
    const ZoneIndex z = _data.zones->of(b, 0);
    if (z == zone || (_data.shell.points.count(b) == 0 && !_data.table.is_met(b))) continue;
    _data.tree->for_each_block_in(GridBox::of(_data.tree->cube(b)).dilated(0.5), [&](BlockIndex n) {
      if (_data.zones->has(zone, n)) ++counts[z];
    });
  }
  counts = sum_by_zone(_communicator, std::move(counts));
  const auto most = std::max_element(counts.begin(), counts.end());
  return *most == 0 ? no_zone : static_cast<ZoneIndex>(most - counts.begin());
}

void ZoneLadder::merge(ZoneIndex a, ZoneIndex b) {
  const ZoneIndex low = std::min(a, b), high = std::max(a, b);
  _data.zones->merge(high, low);
  _is_gone[high] = 1;
  _merged[low] = _merged[high] = 1;
  _changes_of[low] = 0;
  _data.expected[low] += _data.expected[high];
}

void ZoneLadder::touch_all(ZoneIndex zone, Changed& changed) const {
  for (BlockIndex b = _data.tree->first(); b < _data.tree->last(); ++b) {
    if (_data.zones->has(zone, b)) changed.blocks[b - _data.tree->first()] = 1;
  }
}

/// The zones that changed and those that know leaves of the touched blocks, ascending. Collective.
std::vector<ZoneIndex> ZoneLadder::those_that_see(Changed changed) {
  std::vector<double> widest = widths();
  widest.assign(widest.size(), *std::max_element(widest.begin(), widest.end()));
  ZonesAround around(*_data.frame, *_data.tree, _data.table, *_data.zones, widest);
  for (BlockIndex b = _data.tree->first(); b < _data.tree->last(); ++b) {
    if (!changed.blocks[b - _data.tree->first()]) continue;
    around.move_to(b);
    for (const NearZone& near : around.zones()) changed.zones.push_back(near.zone);
  }
  keep_each_once(changed.zones);
  changed.zones = _communicator.all_gather_items<ZoneIndex>(changed.zones);
  keep_each_once(changed.zones);
  std::erase_if(changed.zones, [&](ZoneIndex z) { return is_gone(z); });
  return std::move(changed.zones);
}

// --- zones that disagree

std::vector<ZoneIndex> ZoneLadder::resolve_disputes(std::span<const ZoneFace> faces) {
  const std::vector<ZoneFace> unmatched = find_unmatched(_communicator, faces);
  if (unmatched.empty()) return {};
  ++_rounds_of_giving;
  Changed changed = nothing();
  std::vector<DisputedPlace> places = find_places(unmatched);
  for (DisputedPlace& place : places) {
    changed.zones.insert(changed.zones.end(), place.zones.begin(), place.zones.end());
    if (place.leaves.empty()) place.leaves.push_back(lowest_leaf(place.zones.front()));
  }
  note_places(places);
  if (_rounds_of_giving <= most_rounds_of_giving)
    give(places, changed);
  else
    merge_those_around(places, changed);
  return those_that_see(std::move(changed));
}

/// Any leaf of a zone will do where TetGen added all the vertices. Collective.
LeafNumber ZoneLadder::lowest_leaf(ZoneIndex zone) const {
  std::int64_t lowest = INT64_MAX;
  for (BlockIndex b = _data.tree->last(); b-- > _data.tree->first();) {
    for (int child = _data.tree->leaf_count(b); child-- > 0;) {
      if (_data.zones->of(b, child) == zone) lowest = _data.tree->number(Leaf{b, child});
    }
  }
  lowest = _communicator.minimum(lowest);
  return lowest == INT64_MAX ? 0 : lowest;
}

/// The leaves of places and those less than `rings` leaves away from one, by place. Collective.
std::vector<ZoneLadder::LeafOfPlace> ZoneLadder::leaves_around(std::span<const DisputedPlace> places,
                                                               int rings) const {
  const LatticeTree& tree = *_data.tree;
  std::vector<LeafOfPlace> found;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const LeafNumber number : places[i].leaves) {
      if (tree.owner(number / 8) != _communicator.rank()) continue;
      const Leaf leaf = tree.leaf_of(number);
      found.push_back({static_cast<std::int32_t>(i), _data.zones->of(leaf.block, leaf.child), number,
                       GridBox::of(tree.leaf(leaf))});
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
    tree.for_each_own_block_in(box, [&](BlockIndex n) {
      for (int child = 0; child < tree.leaf_count(n); ++child) {
        const GridBox leaf = GridBox::of(tree.leaf(n, child));
        if (leaf.overlaps(box))
          around.push_back({center.place, _data.zones->of(n, child), tree.number(Leaf{n, child}), leaf});
      }
    });
  }
  around = _communicator.all_gather_items<LeafOfPlace>(around);
  std::sort(around.begin(), around.end(), in_order);
  around.erase(std::unique(around.begin(), around.end(),
                           [](const LeafOfPlace& a, const LeafOfPlace& b) {
                             return a.place == b.place && a.leaf == b.leaf;
                           }),
               around.end());
  return around;
}

/// Tells where each is: in the middle of its first leaf. Collective.
void ZoneLadder::note_places(std::span<const DisputedPlace> places) {
  std::int32_t next = 0;
  for (const LeafOfPlace& leaf : leaves_around(places, 0)) {
    if (leaf.place != next) continue;
    const DisputedPlace& place = places[next++];
    const Vec3 where = _data.frame->to_space(0.5 * (leaf.box.low + leaf.box.high));
    _report.disagreements.push_back({where, place.zones.front(), place.faces, _rounds_of_giving});
    parallel::log_verbose(fmt::format("volume: {} faces of {} zones differ around ({:.6g}, {:.6g}, {:.6g})",
                                      place.faces, place.zones.size(), where.x, where.y, where.z));
  }
}

/// The leaves of places, from the second round on with more and more of those around them. Collective.
void ZoneLadder::give(std::span<const DisputedPlace> places, Changed& changed) {
  for (const LeafOfPlace& given : leaves_around(places, _rounds_of_giving - 1)) {
    const BlockNumber block = given.leaf / 8;
    if (_data.tree->owner(block) == _communicator.rank())
      changed.blocks[_data.tree->index(block) - _data.tree->first()] = 1;
    _data.zones->give(
        {block, static_cast<int>(given.leaf % 8), given.box, places[given.place].zones.front()});
  }
}

/// Makes one zone of all that claim faces at a place or have leaves around it. Collective.
void ZoneLadder::merge_those_around(std::span<const DisputedPlace> places, Changed& changed) {
  std::vector<std::vector<ZoneIndex>> zones;
  for (const DisputedPlace& place : places) zones.push_back(place.zones);
  for (const LeafOfPlace& leaf : leaves_around(places, 2)) zones[leaf.place].push_back(leaf.zone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    keep_each_once(zones[i]);
    std::vector<ZoneIndex> left = zones[i];  // another place may have merged some of them
    std::erase_if(left, [&](ZoneIndex z) { return is_gone(z); });
    if (left.size() == zones[i].size() && left.size() < 2) {
      const Vec3 where = _report.disagreements[_report.disagreements.size() - places.size() + i].place;
      throw parallel::CollectiveError(
          parallel::FailureKind::input,
          fmt::format(
              "the tetrahedra around ({:.6g}, {:.6g}, {:.6g}) fit together in no way that was tried. Use "
              "other sizes there, or another piece size (VolumeOptions::piece_tets)",
              where.x, where.y, where.z));
    }
    for (const ZoneIndex z : left) touch_all(z, changed);
    for (const ZoneIndex z : left) {
      if (z != left.front()) merge(left.front(), z);
    }
  }
}

}  // namespace aeroloom::volume
