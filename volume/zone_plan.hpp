/// Who fills which zone, and with what.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "volume/halo.hpp"
#include "volume/zone_supply.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// What a zone knows, halo included.
struct ZoneLoad {
  ZoneIndex zone;
  float points;  ///< of the lattice
  float triangles;

  /// Expected tetrahedra.
  double work() const { return tetrahedra_per_point * points + tetrahedra_per_triangle * triangles; }
};

/// Zones that are to be filled.
struct ZonePlan {
  std::vector<ZoneLoad> loads;               ///< of all of them, by zone, the same on every rank
  std::vector<std::vector<ZoneWant>> wants;  ///< batch after batch, of the zones this rank has looked at
};

/// What everyone knows of the blocks.
struct BlockTables {
  const LatticeFrame& frame;
  const LatticeTree& tree;
  const SurfaceTable& table;
  std::span<const std::uint8_t> points;  ///< of the lattice, per block
  const Zones& zones;
};

/// Finds what zones want, `width(zone)` being that of their halo, and deals them out, largest first, in
/// batches of a few zones for each rank. Collective.
ZonePlan plan_zones(const parallel::Communicator& communicator, const BlockTables& blocks,
                    const std::vector<ZoneIndex>& zones, std::span<const double> widths,
                    parallel::StageClock& clock);

}  // namespace aeroloom::volume
