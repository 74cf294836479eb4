/// What TetGen fills: the space between the surface and the core, divided into zones.
#pragma once

#include "volume/core/core_border.hpp"
#include "volume/zones/zones.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::volume {

/// Made from a Lattice. Only retries change it: they reassign leaves, merge zones, and make the points anew.
struct Shell {
  LocalShell local;
  Zones zones;
  std::vector<double> expected;      ///< tetrahedra per zone, without the core's
  std::int64_t core_piece_tets = 0;  ///< wanted tetrahedra of a piece of the core
};

}  // namespace aeroloom::volume
