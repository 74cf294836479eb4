/// Ghosts across the borders of zones.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/neighbourhood.hpp"
#include "volume/zones/zone_cuts.hpp"

#include <vector>

namespace aeroloom::volume {

/// The cubes of blocks across the borders of zones that halos of a width are told by (ZonesAround).
/// Collective.
std::vector<GridCube> fetch_cut_ghosts(const Lattice& lattice, const ZoneCuts& cuts, double width);

}  // namespace aeroloom::volume
