/// Assigns zones to ranks, and finds their points and triangles.
#pragma once

#include "volume/filling/zone_inputs.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The size of a zone, halo included. Zones are scheduled by it.
struct ZoneLoad {
  ZoneIndex zone;
  std::int64_t points;  ///< of the lattice
  std::int64_t triangles;
  /// The expected cost of filling, in lattice points. A triangle adds half a point, and has to be recovered.
  /// Measured on a DLR-F6 in nine zones: about 11 microseconds of CPU for a point, 13 for a triangle.
  double work() const { return double(points) + work_per_triangle * double(triangles); }
  static constexpr double work_per_triangle = 1.2;
};

/// The zones to be filled, and what this rank sends to them.
struct ZonePlan {
  std::vector<ZoneLoad> loads;    ///< by zone, the same on every rank
  std::vector<SendPlan> batches;  ///< of the data of this rank, one after the other
};

/// Finds the points and triangles of zones in this rank's blocks. Assigns zones to ranks, largest first, in
/// batches of a few zones per rank. `widths` has the width of each zone's halo, in sizes. Collective.
ZonePlan plan_zones(const Lattice& lattice, const Shell& shell, std::span<const ZoneIndex> zones,
                    std::span<const double> widths);

}  // namespace aeroloom::volume
