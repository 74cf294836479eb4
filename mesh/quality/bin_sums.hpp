/// Sums of counts over all ranks.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// Sums arrays of equal length over all ranks. Each rank adds up its own stretch, so no rank holds one array
/// per rank. Collective.
std::vector<std::int64_t> sum_bins(const parallel::Communicator& communicator,
                                   const std::vector<std::int64_t>& bins);

}  // namespace aeroloom::mesh
