/// Fills a zone in a sandboxed child process.
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
  std::string failure;                ///< the reason, if not filled: one line or more
  OwnedCells owned;                   ///< cells in Morton order
  std::vector<geometry::Vec3> added;  ///< points that TetGen added, numbered after the given ones
  double cpu_seconds = 0;             ///< of the child
  std::int64_t child_peak_bytes = 0;
};

/// The expected number of tetrahedra, halo included.
std::int64_t predict_tetrahedra(const ZoneProblem& problem);

/// Runs TetGen in a child process. Its limits of CPU time, added to `base_cpu_seconds`, and of memory follow
/// from the predicted tetrahedra. A crash of the child does not harm the caller. A result found in `tasks` is
/// returned without a run; new results are stored there.
ZoneFilling fill_zone_in_child(const ZoneProblem& problem, parallel::Fault fault,
                               parallel::TaskStore* tasks = nullptr,
                               double base_cpu_seconds = VolumeOptions().base_cpu_seconds);

}  // namespace aeroloom::volume
