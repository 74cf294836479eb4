#include "pipeline/forecast.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/memory_limit.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

// What a run costs on one core, from runs at a million tetrahedra (docs/status.md).
constexpr double seconds_per_triangle = 80e-6, seconds_per_tetrahedron = 6e-6;
constexpr double base_bytes = 150e6, bytes_per_tetrahedron = 120;

constexpr double gibibyte = 1024.0 * 1024 * 1024;

/// What would fit on a node of `ranks_here` of all `ranks`, where `needed` bytes do not.
std::string advise(double tetrahedra, double limit, int ranks_here, int ranks) {
  const double for_elements = limit - base_bytes * ranks_here;
  if (for_elements <= 0) {
    return fmt::format("{} rank(s) on a node take {:.3g} GiB before the first element: fewer ranks on each",
                       ranks_here, base_bytes * ranks_here / gibibyte);
  }
  const double fitting = for_elements * ranks / (bytes_per_tetrahedron * ranks_here);
  return fmt::format(
      "{:.2g} tetrahedra would fit: sizes {:.2f} times as large (sizing.minimum, sizing.maximum "
      "or sizing.target_tetrahedra), or {} times as many nodes",
      fitting, std::cbrt(tetrahedra / fitting), std::ceil(tetrahedra / fitting));
}

}  // namespace

double predicted_seconds(const sizing::PredictedCounts& counts) {
  return seconds_per_triangle * counts.triangles + seconds_per_tetrahedron * counts.tetrahedra;
}

double predicted_bytes(const sizing::PredictedCounts& counts, int ranks) {
  return base_bytes * ranks + bytes_per_tetrahedron * counts.tetrahedra;
}

void require_memory(const parallel::Communicator& communicator, const SizedDomain& sized,
                    std::int64_t bytes_of_node) {
  const auto limit = static_cast<double>(communicator.minimum(bytes_of_node));
  if (limit <= 0) return;
  const int ranks = communicator.size();
  const auto ranks_here = static_cast<int>(
      communicator.maximum(std::int64_t{parallel::find_node_shape(communicator).ranks_here}));
  const sizing::PredictedCounts& counts = sized.counts;
  const double needed = predicted_bytes(counts, ranks) * ranks_here / ranks;
  if (needed <= limit) return;
  throw parallel::CollectiveError(
      parallel::FailureKind::resources,
      fmt::format(
          "about {:.2g} tetrahedra are predicted, which take {:.3g} GiB on a node with {} of {} rank(s); "
          "{:.3g} GiB are allowed (--max-memory). {}",
          counts.tetrahedra, needed / gibibyte, ranks_here, ranks, limit / gibibyte,
          advise(counts.tetrahedra, limit, ranks_here, ranks)));
}

}  // namespace aeroloom::pipeline
