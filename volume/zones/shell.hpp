/// The shell: the space between surface and core, which TetGen fills zone by zone.
#pragma once

#include "volume/core/core_border.hpp"
#include "volume/zones/zones.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::volume {

/// Made from a Lattice. Only retries change it: they reassign leaves, merge zones, or replace the points.
struct Shell {
  LocalShell local;
  Zones zones;
  std::vector<double> expected;      ///< tetrahedra per zone, without those of the core
  std::int64_t core_piece_tets = 0;  ///< wanted number of tetrahedra of a piece of the core
};

}  // namespace aeroloom::volume
