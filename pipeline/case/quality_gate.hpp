/// The quality that a mesh must have for the run to succeed.
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
struct SolverQuality;
}  // namespace aeroloom::mesh

namespace aeroloom::cases {

/// Limits; empty members are not checked. Angles in degrees. The limits of smallest and largest angle ignore
/// tetrahedra that the CAD forces (improve/attribution/pinned.hpp), but not those at features finer than the
/// elements.
struct QualityGate {
  std::optional<double> smallest_angle, largest_angle;
  std::optional<double> percentile_01, percentile_1, percentile_5;  ///< of the smallest angles
  std::optional<double> min_mean_ratio, mean_mean_ratio;
  std::optional<double> largest_volume_ratio, largest_edge_ratio,
      min_scaled_jacobian;  ///< mesh/quality/cell_measures.hpp
  std::optional<double> largest_non_orthogonality, largest_skewness, largest_aspect_ratio,
      min_determinant;  ///< mesh/quality/face_measures.hpp

  /// Relative deviation of the wall area from that of the CAD faces. Only a run has both.
  double area_deviation = 0.1;

  /// Whether mesh::measure_quality() is needed.
  bool asks_for_cells() const { return largest_volume_ratio || largest_edge_ratio || min_scaled_jacobian; }
  /// Whether mesh::measure_as_solvers() is needed.
  bool asks_for_faces() const {
    return largest_non_orthogonality || largest_skewness || largest_aspect_ratio || min_determinant;
  }
};
/// The keys of `improve.gate`.
inline constexpr std::array<std::string_view, 14> gate_keys = {"smallest_angle",
                                                               "largest_angle",
                                                               "percentile_01",
                                                               "percentile_1",
                                                               "percentile_5",
                                                               "min_mean_ratio",
                                                               "mean_mean_ratio",
                                                               "largest_volume_ratio",
                                                               "largest_edge_ratio",
                                                               "min_scaled_jacobian",
                                                               "largest_non_orthogonality",
                                                               "largest_skewness",
                                                               "largest_aspect_ratio",
                                                               "min_determinant"};

/// The percentile limits, as further targets of improvement.
std::vector<improve::PercentileTarget> percentile_targets(const QualityGate& gate);

/// A limit and the value of the mesh.
struct GateLimit {
  std::string key;  ///< of the case
  double limit = 0, value = 0;
  bool at_most = false;
  bool met() const { return at_most ? value <= limit : value >= limit; }
};

/// What is measured of all shapes. Members may be null unless the gate needs them.
struct MeasuredCells {
  const mesh::MixedQuality* cells = nullptr;
  const mesh::SolverQuality* solver = nullptr;
};

/// All limits that are set, in the order of their keys.
std::vector<GateLimit> compare_with_gate(const QualityGate& gate, const mesh::QualitySummary& quality,
                                         const attribution::PinnedReport& pinned,
                                         const MeasuredCells& measured);

/// A message about missed limits, with values and the place of the worst tetrahedron. Empty if none is
/// missed.
std::string missed_limits(const QualityGate& gate, const mesh::QualitySummary& quality,
                          const attribution::PinnedReport& pinned, const MeasuredCells& measured);

/// The same for a mesh from a file, one line for each limit. Angles are those of all cells; percentiles and
/// mean ratios are those of tetrahedra.
std::string missed_limits(const QualityGate& gate, const mesh::MixedQuality& cells,
                          const mesh::SolverQuality& solver);

}  // namespace aeroloom::cases
