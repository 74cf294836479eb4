#include "pipeline/case/quality_gate.hpp"

#include "geometry/place_text.hpp"
#include "improve/attribution/pinned.hpp"
#include "mesh/quality/cell_measures.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/solver_quality.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

using mesh::Measure;
using mesh::SolverMeasure;

std::string line(const char* key, double value, double limit, const char* side) {
  return fmt::format("\n  improve.gate.{} is {:.4g}, not {:g} {}", key, value, limit, side);
}

/// The worst cell against the limit of its measure; `what` of it has the value.
std::string missed_by(const mesh::WorstCellOfShape& worst, double limit, bool at_most, const char* key,
                      const char* what) {
  if (at_most ? worst.value <= limit : worst.value >= limit) return {};
  return line(key, worst.value, limit, at_most ? "at most" : "at least") +
         fmt::format(" ({}cell {} of the {}, at {:.6g}, {:.6g}, {:.6g})", what, worst.cell,
                     mesh::name_of(worst.shape), worst.center.x, worst.center.y, worst.center.z);
}

std::string missed_limit(const mesh::MixedQuality& cells, Measure measure, const std::optional<double>& limit,
                         const char* key) {
  const auto& worst = cells.worst[static_cast<std::size_t>(measure)];
  if (!limit || worst.empty()) return {};
  return missed_by(worst.front(), *limit, mesh::larger_is_worse(measure), key, "");
}

std::string missed_ratios(const QualityGate& gate, const mesh::MixedQuality& cells) {
  return missed_limit(cells, Measure::volume_ratio, gate.largest_volume_ratio, "largest_volume_ratio") +
         missed_limit(cells, Measure::edge_ratio, gate.largest_edge_ratio, "largest_edge_ratio") +
         missed_limit(cells, Measure::scaled_jacobian, gate.min_scaled_jacobian, "min_scaled_jacobian");
}

/// A limit on a measure of cell-centred solvers.
struct SolverLimit {
  const char* key;
  SolverMeasure measure;
  const std::optional<double>& limit;
};
std::array<SolverLimit, 4> solver_limits(const QualityGate& gate) {
  return {{{"largest_non_orthogonality", SolverMeasure::non_orthogonality, gate.largest_non_orthogonality},
           {"largest_skewness", SolverMeasure::skewness, gate.largest_skewness},
           {"largest_aspect_ratio", SolverMeasure::aspect_ratio, gate.largest_aspect_ratio},
           {"min_determinant", SolverMeasure::determinant, gate.min_determinant}}};
}

std::string missed_by_solvers(const QualityGate& gate, const mesh::SolverQuality& solver) {
  std::string text;
  for (const auto& [key, measure, limit] : solver_limits(gate)) {
    if (!limit || solver.worst_of(measure).empty()) continue;
    const bool of_face = measure == SolverMeasure::non_orthogonality || measure == SolverMeasure::skewness;
    text += missed_by(solver.worst_of(measure).front(), *limit, mesh::larger_is_worse(measure), key,
                      of_face ? "a face of " : "");
  }
  return text;
}

}  // namespace

std::vector<improve::PercentileTarget> percentile_targets(const QualityGate& gate) {
  std::vector<improve::PercentileTarget> targets;
  if (gate.percentile_01) targets.push_back({0.001, *gate.percentile_01});
  if (gate.percentile_1) targets.push_back({0.01, *gate.percentile_1});
  if (gate.percentile_5) targets.push_back({0.05, *gate.percentile_5});
  return targets;
}

std::vector<GateLimit> compare_with_gate(const QualityGate& gate, const mesh::QualitySummary& quality,
                                         const attribution::PinnedReport& pinned,
                                         const MeasuredCells& measured) {
  std::vector<GateLimit> limits;
  const auto compare = [&](const char* key, const std::optional<double>& limit, double value,
                           bool at_most = false) {
    if (limit) limits.push_back({fmt::format("improve.gate.{}", key), *limit, value, at_most});
  };
  const auto compare_cells = [&](const char* key, const std::optional<double>& limit, Measure measure) {
    const mesh::MixedQuality* const cells = measured.cells;
    if (cells == nullptr || cells->worst[static_cast<std::size_t>(measure)].empty()) return;
    compare(key, limit, cells->worst[static_cast<std::size_t>(measure)].front().value,
            mesh::larger_is_worse(measure));
  };
  const bool some_pinned = pinned.tetrahedra > 0;
  compare("smallest_angle", gate.smallest_angle,
          some_pinned ? std::max(pinned.smallest_angle, quality.min_dihedral.minimum)
                      : quality.min_dihedral.minimum);
  compare("largest_angle", gate.largest_angle,
          some_pinned ? std::min(pinned.largest_angle, quality.max_dihedral.maximum)
                      : quality.max_dihedral.maximum,
          true);
  compare("percentile_01", gate.percentile_01, quality.min_dihedral.percentile_01);
  compare("percentile_1", gate.percentile_1, quality.min_dihedral.percentile_1);
  compare("percentile_5", gate.percentile_5, quality.min_dihedral.percentile_5);
  compare("min_mean_ratio", gate.min_mean_ratio, quality.mean_ratio.minimum);
  compare("mean_mean_ratio", gate.mean_mean_ratio, quality.mean_ratio.mean);
  compare_cells("largest_volume_ratio", gate.largest_volume_ratio, Measure::volume_ratio);
  compare_cells("largest_edge_ratio", gate.largest_edge_ratio, Measure::edge_ratio);
  compare_cells("min_scaled_jacobian", gate.min_scaled_jacobian, Measure::scaled_jacobian);
  for (const auto& [key, measure, limit] : solver_limits(gate)) {
    if (measured.solver != nullptr && !measured.solver->worst_of(measure).empty())
      compare(key, limit, measured.solver->worst_of(measure).front().value, mesh::larger_is_worse(measure));
  }
  return limits;
}

std::string missed_limits(const QualityGate& gate, const mesh::QualitySummary& quality,
                          const attribution::PinnedReport& pinned, const MeasuredCells& measured) {
  std::string text = measured.cells != nullptr ? missed_ratios(gate, *measured.cells) : "";
  if (measured.solver != nullptr) text += missed_by_solvers(gate, *measured.solver);
  for (const GateLimit& limit : compare_with_gate(gate, quality, pinned, {})) {
    if (!limit.met())
      text += fmt::format("\n  {} is {:.4g}, not {:g} {}", limit.key, limit.value, limit.limit,
                          limit.at_most ? "at most" : "at least");
  }
  if (text.empty()) return text;
  std::string place;
  if (!quality.worst.empty()) {
    const mesh::WorstCell& worst = quality.worst.front();
    place = fmt::format("\n  the worst tetrahedron has {:.4g} degrees at {}", worst.value,
                        geometry::place_text(worst.center));
  }
  return "the mesh misses what was asked for; it was written nevertheless:" + text + place +
         "\n  remedy: a larger improve.target_angle, smaller sizes there, or lower limits";
}

std::string missed_limits(const QualityGate& gate, const mesh::MixedQuality& cells,
                          const mesh::SolverQuality& solver) {
  std::string text = missed_limit(cells, Measure::smallest_dihedral, gate.smallest_angle, "smallest_angle") +
                     missed_limit(cells, Measure::largest_dihedral, gate.largest_angle, "largest_angle");
  const mesh::MeasureDistribution& angles =
      cells.distribution(mesh::CellShape::tetrahedron, Measure::smallest_dihedral);
  const mesh::MeasureDistribution& ratios =
      cells.distribution(mesh::CellShape::tetrahedron, Measure::mean_ratio);
  const auto at_least = [&](const std::optional<double>& limit, double value, const char* key) {
    if (limit && angles.cells > 0 && value < *limit) text += line(key, value, *limit, "at least");
  };
  at_least(gate.percentile_01, angles.percentiles[0], "percentile_01");
  at_least(gate.percentile_1, angles.percentiles[1], "percentile_1");
  at_least(gate.percentile_5, angles.percentiles[2], "percentile_5");
  text += missed_limit(cells, Measure::mean_ratio, gate.min_mean_ratio, "min_mean_ratio");
  at_least(gate.mean_mean_ratio, ratios.mean, "mean_mean_ratio");
  text += missed_ratios(gate, cells) + missed_by_solvers(gate, solver);
  return text.empty() ? text : "the mesh misses what was asked for:" + text;
}

}  // namespace aeroloom::cases
