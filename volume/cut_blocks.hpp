/// Blocks of other ranks across the borders of zones.
#pragma once

#include "aeroloom/parallel/communication/communicator.hpp"
#include "aeroloom/parallel/observation/timers.hpp"
#include "volume/neighbourhood.hpp"
#include "volume/zone_cuts.hpp"

namespace aeroloom::volume {

/// Blocks across the borders of zones that halos of a width are told by (ZonesAround). Tree and table grow;
/// indices of blocks change. Collective.
void learn_what_is_cut(const parallel::Communicator& communicator, const KnownLattice& lattice,
                       const ZoneCuts& cuts, double width, parallel::StageClock& clock);

}  // namespace aeroloom::volume
