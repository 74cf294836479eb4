#include "volume/zone_ladder.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "volume/filling_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::volume {
namespace {

/// Rounds in which leaves are given away where zones disagree; after that such zones are merged.
constexpr int most_rounds_of_giving = 3;

}  // namespace

std::vector<double> ZoneLadder::widths() const {
  std::vector<double> widths;
  for (const int changes : _changes_of) widths.push_back(_input.options.halo * std::pow(wider, changes));
  return widths;
}

/// Calls visit(block, child) for the leaves of a place and those less than `rings` leaves away from one.
template <class Visit>
void ZoneLadder::for_each_leaf_around(const DisputedPlace& place, int rings, const Visit& visit) const {
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

std::vector<ZoneIndex> ZoneLadder::change_failed(const std::vector<ZoneFailure>& mine,
                                                 const std::vector<LeavingLeaf>& leaving_here,
                                                 const Evidence& evidence) {
  const std::vector<ZoneFailure> failures = gather_failures(_communicator, mine);
  const std::vector<LeavingLeaf> leaving = _communicator.all_gather_items<LeavingLeaf>(leaving_here);
  if (failures.empty() && leaving.empty()) return {};
  if (!failures.empty()) evidence.stop_at_defects(_communicator);
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
      if (with == no_zone) evidence.give_up(_communicator, failure.zone, _report.retries);
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
ZoneIndex ZoneLadder::widest_neighbour(ZoneIndex zone, std::span<const BlockIndex> own) const {
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

void ZoneLadder::merge(ZoneIndex a, ZoneIndex b) {
  const ZoneIndex low = std::min(a, b), high = std::max(a, b);
  _data.zones->merge(high, low);
  _is_gone[high] = 1;
  _merged[low] = _merged[high] = 1;
  _changes_of[low] = 0;
  _data.expected[low] += _data.expected[high];
}

/// Adds the zones that know leaves of the touched blocks, sorts, each once; those without blocks go.
void ZoneLadder::add_those_that_see(const std::vector<std::uint8_t>& touched,
                                    std::vector<ZoneIndex>& pending) {
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

std::vector<ZoneIndex> ZoneLadder::settle_disputes(std::span<const ZoneFace> faces) {
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
std::vector<ZoneIndex> ZoneLadder::zones_around(const DisputedPlace& place) const {
  std::vector<ZoneIndex> zones = place.zones;
  for_each_leaf_around(place, 2,
                       [&](BlockIndex b, int child) { zones.push_back(_data.zones->of(b, child)); });
  std::sort(zones.begin(), zones.end());
  zones.erase(std::unique(zones.begin(), zones.end()), zones.end());
  return zones;
}

/// Makes one zone of several, some of which another place may have merged before. False: they were one
/// already.
bool ZoneLadder::merge_all(const std::vector<ZoneIndex>& zones, std::vector<std::uint8_t>& touched) {
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

void ZoneLadder::throw_dispute(geometry::Vec3 where) const {
  throw parallel::CollectiveError(
      parallel::FailureKind::input,
      fmt::format(
          "the tetrahedra around ({:.6g}, {:.6g}, {:.6g}) fit together in no way that was tried. Use other "
          "sizes there, or another piece size (VolumeOptions::piece_tets)",
          where.x, where.y, where.z));
}

/// The middle of a place's first leaf; of the zone's, where none of the vertices there has one.
geometry::Vec3 ZoneLadder::middle_of(const DisputedPlace& place, ZoneIndex zone) const {
  Leaf leaf{0, 0};
  if (!place.leaves.empty()) {
    leaf = leaf_of_number(place.leaves.front());
  } else if (const BlocksOfZones blocks = list_blocks(*_data.tree, *_data.zones); !blocks.of(zone).empty()) {
    leaf.block = blocks.of(zone).front();
  }
  const GridBox box = GridBox::of(_data.tree->leaf(leaf));
  return _data.frame->to_space(0.5 * (box.low + box.high));
}

/// The leaves of a place, from the second round on with more and more of those around them.
void ZoneLadder::give(const DisputedPlace& place, ZoneIndex to, std::vector<std::uint8_t>& touched) {
  for_each_leaf_around(place, _rounds_of_giving - 1, [&](BlockIndex b, int child) {
    touched[b] = 1;
    _data.zones->give(b, child, to);
  });
}

}  // namespace aeroloom::volume
