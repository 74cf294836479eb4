/// What a mesh has to be like for the run to count as a success.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/pinned.hpp"
#include "mesh/quality.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// Limits; what is empty is not asked for. Angles in degrees. Tetrahedra that the CAD forces
/// (improve/pinned.hpp) do not count for the smallest and the largest angle; those at features finer than the
/// elements do.
struct QualityGate {
  std::optional<double> smallest_angle, largest_angle;
  std::optional<double> percentile_01, percentile_1, percentile_5;  ///< of the smallest angles
  std::optional<double> min_mean_ratio, mean_mean_ratio;
};

/// What improvement is to work on beside its target.
std::vector<improve::PercentileTarget> percentile_targets(const QualityGate& gate);

/// The limits that the mesh misses, with what it has and where the worst tetrahedron is; empty: none.
std::string missed_limits(const QualityGate& gate, const mesh::QualitySummary& quality,
                          const improve::PinnedReport& pinned);

}  // namespace aeroloom::pipeline
