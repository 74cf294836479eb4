/// Who fills which zone, and with what.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "volume/halo.hpp"
#include "volume/zone_supply.hpp"

#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// What a zone knows, halo included.
struct ZoneLoad {
  ZoneIndex zone;
  float points;  ///< of the lattice
  float triangles;

  static constexpr auto fields() {
    return std::tuple(&ZoneLoad::zone, &ZoneLoad::points, &ZoneLoad::triangles);
  }
  /// Expected cost of filling, in that of a lattice point: a triangle brings half a point, and has to be
  /// recovered. Measured on a DLR-F6 in nine zones: about 11 microseconds of CPU for a
  /// point, 13 for a triangle.
  double work() const { return points + work_per_triangle * triangles; }
  static constexpr double work_per_triangle = 1.2;
};

/// Zones that are to be filled.
struct ZonePlan {
  std::vector<ZoneLoad> loads;               ///< of all of them, by zone, the same on every rank
  std::vector<double> widths;                ///< of the halo, per zone
  std::vector<std::vector<ZoneWant>> wants;  ///< batch after batch, of the zones this rank has looked at
};

/// Finds what zones want, `widths[zone]` being that of their halo, and deals them out, largest first, in
/// batches of a few zones for each rank. Collective.
ZonePlan plan_zones(const parallel::Communicator& communicator, const BlockTables& blocks,
                    const std::vector<ZoneIndex>& zones, std::span<const double> widths,
                    parallel::StageClock& clock);

}  // namespace aeroloom::volume
