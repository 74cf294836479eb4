/// Pretends that the ranks are spread over several nodes, for tests on one machine. Internal to parallel/.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::parallel {

/// The same ranks, where each `ranks_per_node` consecutive ones count as a node. Collective.
Communicator impose_nodes(const Communicator& communicator, int ranks_per_node);

}  // namespace aeroloom::parallel
