/// Predicts the time of message exchanges on any number of ranks from latency and bandwidth.
#pragma once

#include "pipeline/study/costs.hpp"

namespace aeroloom::study {

/// The network as one rank sees it. Defaults: a common cluster network, shared by the ranks of a node.
struct Network {
  double latency = 5e-6;   ///< seconds until an empty message arrives
  double bandwidth = 1e9;  ///< bytes per second that a rank can send
};

/// Number of neighbours that a rank exchanges messages with: from the record if known, but at least those
/// around a subdomain in space.
double partners_of(const StageExchanges& exchanges, int recorded, int ranks);

/// Seconds for the exchanges of a stage on `ranks` ranks, without waiting for late ranks (model:
/// docs/scaling_model.md). `recorded`: ranks of the record.
double exchange_seconds(const StageExchanges& exchanges, int recorded, int ranks, const Network& network);

}  // namespace aeroloom::study
