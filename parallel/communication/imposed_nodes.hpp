/// Nodes that somebody else says there are, which is how tests on one machine look at several. Internal to
/// parallel/.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::parallel {

/// The same ranks, so many neighbours of which count as one node each. Collective.
Communicator impose_nodes(const Communicator& communicator, int ranks_per_node);

}  // namespace aeroloom::parallel
