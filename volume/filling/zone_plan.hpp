/// Who fills which zone, and with what.
#pragma once

#include "volume/filling/zone_inputs.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The size of a zone, halo included, by which it is scheduled.
struct ZoneLoad {
  ZoneIndex zone;
  std::int64_t points;  ///< of the lattice
  std::int64_t triangles;
  /// Expected cost of filling, in that of a lattice point: a triangle brings half a point, and has to be
  /// recovered. Measured on a DLR-F6 in nine zones: about 11 microseconds of CPU for a
  /// point, 13 for a triangle.
  double work() const { return double(points) + work_per_triangle * double(triangles); }
  static constexpr double work_per_triangle = 1.2;
};

/// Zones that are to be filled.
struct ZonePlan {
  std::vector<ZoneLoad> loads;    ///< of all of them, by zone, the same on every rank
  std::vector<SendPlan> batches;  ///< of what this rank has, batch after batch
};

/// Finds what zones know of this rank's blocks, `widths[zone]` being that of their halo, and deals zones out,
/// largest first, in batches of a few for each rank. Collective.
ZonePlan plan_zones(const Lattice& lattice, const Shell& shell, std::span<const ZoneIndex> zones,
                    std::span<const double> widths);

}  // namespace aeroloom::volume
