/// One try at filling a zone, in a sandboxed child.
#pragma once

#include "parallel/sandbox/fault.hpp"
#include "parallel/storage/task_store.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/volume_options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// The result of filling a zone.
struct ZoneFilling {
  bool filled = false;
  std::string failure;                ///< why not, one line or more
  OwnedCells owned;                   ///< cells ordered along a space-filling curve
  std::vector<geometry::Vec3> added;  ///< points of TetGen, numbered after the given ones
  double cpu_seconds = 0;             ///< of the child
  std::int64_t child_peak_bytes = 0;
};

/// Tetrahedra to expect, halo included.
std::int64_t predict_tetrahedra(const ZoneProblem& problem);

/// Runs TetGen in a child under limits that follow from the predicted count, the CPU seconds on top of
/// `base_cpu_seconds`. Nothing the child does harms the
/// caller. What is found in `tasks` is not filled again, what is filled is kept there.
ZoneFilling fill_zone_in_child(const ZoneProblem& problem, parallel::Fault fault,
                               parallel::TaskStore* tasks = nullptr,
                               double base_cpu_seconds = VolumeOptions().base_cpu_seconds);

}  // namespace aeroloom::volume
