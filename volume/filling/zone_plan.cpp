#include "volume/filling/zone_plan.hpp"

#include "parallel/communication/schedule.hpp"
#include "parallel/observation/task_kind.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/zones/halo.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::volume {
namespace {

/// The triangles of own blocks, by the block that contains their centre.
class Centres {
public:
  explicit Centres(const Lattice& lattice)
      : _first(lattice.tree.first()), _starts(lattice.tree.last() - _first + 1, 0) {
    std::vector<BlockIndex> blocks;
    blocks.reserve(lattice.triangles.size());
    for (const SurfaceTriangle& t : lattice.triangles) {
      const geometry::Vec3 centre = (1.0 / 3.0) * (t.points[0] + t.points[1] + t.points[2]);
      // The centre of a large triangle may lie in a placeholder.
      blocks.push_back(lattice.tree.any_at(lattice.frame.cell_at(lattice.frame.to_grid(centre))));
      if (is_own(blocks.back())) ++_starts[blocks.back() - _first + 1];
    }
    std::partial_sum(_starts.begin(), _starts.end(), _starts.begin());
    _triangles.resize(_starts.back());
    std::vector<std::int32_t> next(_starts.begin(), _starts.end() - 1);
    for (std::size_t t = 0; t < blocks.size(); ++t) {
      if (is_own(blocks[t])) _triangles[next[blocks[t] - _first]++] = static_cast<std::int32_t>(t);
    }
  }

  std::span<const std::int32_t> of(BlockIndex b) const {
    return std::span(_triangles).subspan(_starts[b - _first], _starts[b - _first + 1] - _starts[b - _first]);
  }

private:
  bool is_own(BlockIndex b) const {
    return b >= _first && b - _first + 1 < static_cast<BlockIndex>(_starts.size());
  }
  BlockIndex _first;
  std::vector<std::int32_t> _starts, _triangles;
};

/// Finds the points and triangles of this rank's blocks that are in zones or their halos.
class Finding {
public:
  Finding(const Lattice& lattice, const Shell& shell, std::span<const ZoneIndex> zones,
          std::span<const double> widths)
      : _lattice(lattice), _shell(shell), _is_wanted(widths.size(), 0) {
    for (const ZoneIndex z : zones) _is_wanted[z] = 1;
    const Centres centres(lattice);
    const BlockPoints& points = shell.local.points;
    ZonesAround around(lattice, shell.zones, widths);
    for (BlockIndex b = points.first; b < points.last(); ++b) {
      if (points.count(b) == 0 && shell.local.borders.of(b).empty() && centres.of(b).empty()) continue;
      around.move_to(b);
      for (const HaloZone& halo : around.zones()) {
        if (!_is_wanted[halo.zone]) continue;
        look_at(halo, b);
        for (const std::int32_t t : centres.of(b)) {
          if (halo.reaches(grid_box(lattice.frame, lattice.triangles[t].points)))
            found.triangles.push_back({halo.zone, t});
        }
      }
    }
  }

  SendPlan found;

private:
  void look_at(const HaloZone& halo, BlockIndex b) {
    const LatticeTree& tree = _lattice.tree;
    SendPlan::OfBlock want{halo.zone, b, 0, 0};
    std::uint8_t own = 0;
    for (int child = 0; child < tree.leaf_count(b); ++child) {
      const bool is_own = _shell.zones.of(b, child) == halo.zone;
      own |= static_cast<std::uint8_t>(is_own << child);
      if (is_own || halo.reaches(GridBox::of(tree.leaf(b, child))))
        want.leaves |= static_cast<std::uint8_t>(1U << child);
    }
    if (want.leaves == 0) return;
    const BlockPoints& points = _shell.local.points;
    const std::int64_t first = points.starts[b - points.first];
    for (std::int64_t i = 0; i < points.count(b); ++i) {
      const int child = points.slots[first + i] / slots_per_leaf;
      if (!(want.leaves >> child & 1)) continue;
      const geometry::Vec3 place = _lattice.frame.to_grid(points.points[first + i]);
      if ((own >> child & 1) || halo.reaches({place, place})) want.points |= std::uint64_t{1} << i;
    }
    if (want.points != 0 || !_shell.local.borders.of(b).empty()) found.blocks.push_back(want);
  }

  const Lattice& _lattice;
  const Shell& _shell;
  std::vector<std::uint8_t> _is_wanted;  // per zone
};

/// The loads of zones, summed over all ranks. Collective.
std::vector<ZoneLoad> add_up(const Zones& all, const SendPlan& mine, std::span<const ZoneIndex> zones) {
  std::vector<std::int64_t> points(all.count(), 0), triangles(all.count(), 0);
  for (const auto& want : mine.blocks) points[want.zone] += __builtin_popcountll(want.points);
  for (const auto& want : mine.triangles) ++triangles[want.zone];
  points = all.sum(std::move(points));
  triangles = all.sum(std::move(triangles));
  std::vector<ZoneLoad> loads;
  for (const ZoneIndex z : zones) loads.push_back({z, points[z], triangles[z]});
  return loads;
}

/// The rank and the batch in which a zone is filled.
struct Assignment {
  parallel::Rank rank = 0;
  std::size_t batch = 0;
};

std::vector<Assignment> schedule_zones(const std::vector<ZoneLoad>& loads, int ranks, std::size_t zones) {
  std::vector<double> work;
  work.reserve(loads.size());
  for (const ZoneLoad& load : loads) work.push_back(load.work());
  const std::vector<parallel::Rank> owners = parallel::assign_largest_first(work, ranks);
  const std::vector<int> batches =
      parallel::batches_of_tasks(owners, work, parallel::row_of(parallel::TaskKind::zone).at_a_time);
  std::vector<Assignment> assignments(zones);
  for (std::size_t i = 0; i < loads.size(); ++i)
    assignments[loads[i].zone] = {owners[i], static_cast<std::size_t>(batches[i])};
  return assignments;
}

/// Divides items among batches, sorted by zone. The order within a zone is kept.
template <class Item, class Member>
void divide(std::vector<Item>& items, const std::vector<Assignment>& assignments,
            std::vector<SendPlan>& batches, Member member) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.zone < b.zone; });
  for (const Item& item : items) (batches[assignments[item.zone].batch].*member).push_back(item);
  std::vector<Item>().swap(items);
}

}  // namespace

ZonePlan plan_zones(const Lattice& lattice, const Shell& shell, std::span<const ZoneIndex> zones,
                    std::span<const double> widths) {
  SendPlan mine;
  parallel::collectively(lattice.tree.communicator(), parallel::ScopedCpu::As::task,
                         [&] { mine = std::move(Finding(lattice, shell, zones, widths).found); });
  ZonePlan plan;
  plan.loads = add_up(shell.zones, mine, zones);
  const std::vector<Assignment> assignments =
      schedule_zones(plan.loads, lattice.tree.communicator().size(), widths.size());
  std::size_t batches = 0;
  for (const ZoneLoad& load : plan.loads) batches = std::max(batches, assignments[load.zone].batch + 1);
  plan.batches.resize(batches);
  divide(mine.blocks, assignments, plan.batches, &SendPlan::blocks);
  divide(mine.triangles, assignments, plan.batches, &SendPlan::triangles);
  for (SendPlan& batch : plan.batches) {
    for (const Assignment& assignment : assignments) batch.ranks.push_back(assignment.rank);
  }
  return plan;
}

}  // namespace aeroloom::volume
