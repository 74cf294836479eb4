#include "volume/zone_plan.hpp"

#include "parallel/schedule.hpp"

#include <algorithm>

namespace aeroloom::volume {
namespace {

/// Zones that a rank is sent at a time.
constexpr std::size_t zones_at_a_time = 4;

/// The wants of one zone, and what they add up to.
ZoneLoad look_at(const BlockTables& blocks, ZoneIndex zone, std::span<const TakenBlock> taken,
                 std::vector<ZoneWant>& wants) {
  ZoneLoad load{zone, 0, 0};
  for (const auto& [block, leaves] : taken) {
    if (blocks.points[block] == 0 && !blocks.borders[block] && !blocks.table.is_met(block)) continue;
    const float part =
        static_cast<float>(__builtin_popcount(leaves)) / static_cast<float>(blocks.tree.leaf_count(block));
    load.points += part * blocks.points[block];
    load.triangles += part * static_cast<float>(blocks.table.triangles[block]);
    wants.push_back({zone, block, 0, leaves});
  }
  return load;
}

/// Where a zone is filled, and in which batch.
struct Turn {
  parallel::Rank rank = 0;
  std::size_t batch = 0;
};

std::vector<Turn> deal_out(const std::vector<ZoneLoad>& loads, int ranks, ZoneIndex zones) {
  std::vector<double> work;
  work.reserve(loads.size());
  for (const ZoneLoad& load : loads) work.push_back(load.work());
  const std::vector<parallel::Rank> owners = parallel::assign_largest_first(work, ranks);
  std::vector<Turn> turns(zones);
  for (parallel::Rank r = 0; r < ranks; ++r) {
    const std::vector<int> tasks = parallel::tasks_of_rank(owners, work, r);
    for (std::size_t i = 0; i < tasks.size(); ++i) turns[loads[tasks[i]].zone] = {r, i / zones_at_a_time};
  }
  return turns;
}

}  // namespace

ZonePlan plan_zones(const parallel::Communicator& communicator, const BlockTables& blocks,
                    const std::vector<ZoneIndex>& zones, std::span<const double> widths,
                    parallel::StageClock& clock) {
  std::vector<ZoneWant> wants;
  std::vector<ZoneLoad> mine;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    const bool whole = blocks.zones.count() == 1;
    const BlocksOfZones own = list_blocks(blocks.tree, blocks.zones);
    HaloTaker taker(blocks.frame, blocks.tree, blocks.table, blocks.zones);
    for (std::size_t i = communicator.rank(); i < zones.size(); i += communicator.size()) {
      const ZoneIndex z = zones[i];
      mine.push_back(
          look_at(blocks, z, whole ? take_all(blocks.tree) : taker.take(z, own.of(z), widths[z]), wants));
    }
  }
  ZonePlan plan;
  plan.widths.assign(widths.begin(), widths.end());
  plan.loads = communicator.all_gather_items<ZoneLoad>(mine);
  std::sort(plan.loads.begin(), plan.loads.end(),
            [](const ZoneLoad& a, const ZoneLoad& b) { return a.zone < b.zone; });
  const std::vector<Turn> turns = deal_out(plan.loads, communicator.size(), blocks.zones.count());
  std::size_t batches = 0;
  for (const ZoneLoad& load : plan.loads) batches = std::max(batches, turns[load.zone].batch + 1);
  plan.wants.resize(batches);
  for (ZoneWant& want : wants) {
    want.rank = turns[want.zone].rank;
    plan.wants[turns[want.zone].batch].push_back(want);
  }
  return plan;
}

}  // namespace aeroloom::volume
