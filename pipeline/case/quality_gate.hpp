/// The quality that a mesh must have for the run to count as a success.
#pragma once

#include "improve/improve_options.hpp"
#include "mesh/quality/quality.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::attribution {
struct PinnedReport;
}

namespace aeroloom::mesh {
struct MixedQuality;
}

namespace aeroloom::cases {

/// Limits; what is empty is not asked for. Angles in degrees. Tetrahedra that the CAD forces
/// (improve/attribution/pinned.hpp) do not count for the smallest and the largest angle; those at features
/// finer than the elements do.
struct QualityGate {
  std::optional<double> smallest_angle, largest_angle;
  std::optional<double> percentile_01, percentile_1, percentile_5;  ///< of the smallest angles
  std::optional<double> min_mean_ratio, mean_mean_ratio;
  std::optional<double> largest_volume_ratio, largest_edge_ratio,
      min_scaled_jacobian;  ///< mesh/quality/cell_measures.hpp

  /// Of the area of all walls from that of their CAD faces, as a share of it; a run alone knows those.
  double area_deviation = 0.1;

  /// Whether io::measure_quality is needed.
  bool asks_for_cells() const { return largest_volume_ratio || largest_edge_ratio || min_scaled_jacobian; }
};
/// The keys under `improve.gate`.
inline constexpr std::array<std::string_view, 10> gate_keys = {
    "smallest_angle", "largest_angle",   "percentile_01",        "percentile_1",       "percentile_5",
    "min_mean_ratio", "mean_mean_ratio", "largest_volume_ratio", "largest_edge_ratio", "min_scaled_jacobian"};

/// The targets of improvement beside its own.
std::vector<improve::PercentileTarget> percentile_targets(const QualityGate& gate);

/// A limit of the gate and what the mesh has.
struct GateLimit {
  std::string key;  ///< of the case
  double limit = 0, value = 0;
  bool at_most = false;
  bool met() const { return at_most ? value <= limit : value >= limit; }
};

/// All limits that are asked for, in the order of their keys. `cells` may be null where the gate does not ask
/// for them.
std::vector<GateLimit> compare_with_gate(const QualityGate& gate, const mesh::QualitySummary& quality,
                                         const attribution::PinnedReport& pinned,
                                         const mesh::MixedQuality* cells);

/// The limits that the mesh misses, with what it has and where the worst tetrahedron is; empty: none. `cells`
/// may be null where the gate does not ask for them.
std::string missed_limits(const QualityGate& gate, const mesh::QualitySummary& quality,
                          const attribution::PinnedReport& pinned, const mesh::MixedQuality* cells);

/// The limits that a mesh from a file misses, a line each with what it has and where; empty: none. Angles
/// count of cells of all shapes, percentiles and mean ratios of tetrahedra.
std::string missed_limits(const QualityGate& gate, const mesh::MixedQuality& cells);

}  // namespace aeroloom::cases
