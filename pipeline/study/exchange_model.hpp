/// How long exchanges take on any number of ranks, by latency and bandwidth.
#pragma once

#include "pipeline/study/costs.hpp"

namespace aeroloom::study {

/// Of a rank and what it is linked to. The defaults are those of a cluster's usual network, shared by the
/// ranks of a node.
struct Network {
  double latency = 5e-6;   ///< seconds until a message of no length is there
  double bandwidth = 1e9;  ///< bytes per second that a rank can send
};

/// Ranks that one has messages for, of `ranks`: those of the record where it tells, but no fewer than around
/// a part of space.
double partners_of(const StageExchanges& exchanges, int recorded, int ranks);

/// Seconds that the exchanges of a stage take on so many ranks, waiting for late ones not included; the model
/// is in docs/scaling_model.md. `recorded` is the number of ranks of the record.
double exchange_seconds(const StageExchanges& exchanges, int recorded, int ranks, const Network& network);

}  // namespace aeroloom::study
