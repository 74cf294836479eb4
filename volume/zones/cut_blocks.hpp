/// Blocks of other ranks across the borders of zones.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/neighbourhood.hpp"
#include "volume/zones/zone_cuts.hpp"

namespace aeroloom::volume {

/// Blocks across the borders of zones that halos of a width are told by (ZonesAround). Tree and table grow;
/// indices of blocks change. Collective.
void learn_what_is_cut(const parallel::Communicator& communicator, const KnownLattice& lattice,
                       const ZoneCuts& cuts, double width);

}  // namespace aeroloom::volume
