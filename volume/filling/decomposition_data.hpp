/// The data of a Decomposition, for decompose() and fill_zones().
#pragma once

#include "volume/filling/zone_plan.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zones/shell.hpp"

#include <memory>

namespace aeroloom::volume {

struct Decomposition::Data {
  std::unique_ptr<const Lattice> lattice;
  Shell shell;    ///< refers to the lattice
  ZonePlan plan;  ///< before any retry, for all zones
  DecompositionReport report;
};

}  // namespace aeroloom::volume
