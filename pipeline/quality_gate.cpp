#include "pipeline/quality_gate.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {

std::vector<improve::PercentileTarget> percentile_targets(const QualityGate& gate) {
  std::vector<improve::PercentileTarget> targets;
  if (gate.percentile_01) targets.push_back({0.001, *gate.percentile_01});
  if (gate.percentile_1) targets.push_back({0.01, *gate.percentile_1});
  if (gate.percentile_5) targets.push_back({0.05, *gate.percentile_5});
  return targets;
}

std::string missed_limits(const QualityGate& gate, const mesh::QualitySummary& quality,
                          const improve::PinnedReport& pinned) {
  std::string text;
  const auto at_least = [&](const std::optional<double>& limit, double value, const char* key) {
    if (limit && value < *limit)
      text += fmt::format("\n  {} is {:.4g}, not {:g} at least", key, value, *limit);
  };
  const bool some_pinned = pinned.tetrahedra > 0;
  const double smallest = some_pinned ? std::max(pinned.smallest_angle, quality.min_dihedral.minimum)
                                      : quality.min_dihedral.minimum;
  const double largest = some_pinned ? std::min(pinned.largest_angle, quality.max_dihedral.maximum)
                                     : quality.max_dihedral.maximum;
  at_least(gate.smallest_angle, smallest, "improve.gate.smallest_angle");
  if (gate.largest_angle && largest > *gate.largest_angle) {
    text += fmt::format("\n  improve.gate.largest_angle is {:.4g}, not {:g} at most", largest,
                        *gate.largest_angle);
  }
  at_least(gate.percentile_01, quality.min_dihedral.percentile_01, "improve.gate.percentile_01");
  at_least(gate.percentile_1, quality.min_dihedral.percentile_1, "improve.gate.percentile_1");
  at_least(gate.percentile_5, quality.min_dihedral.percentile_5, "improve.gate.percentile_5");
  at_least(gate.min_mean_ratio, quality.mean_ratio.minimum, "improve.gate.min_mean_ratio");
  at_least(gate.mean_mean_ratio, quality.mean_ratio.mean, "improve.gate.mean_mean_ratio");
  if (text.empty()) return text;
  std::string place;
  if (!quality.worst.empty()) {
    const mesh::WorstCell& worst = quality.worst.front();
    place = fmt::format("\n  the worst tetrahedron has {:.4g} degrees at ({:.6g}, {:.6g}, {:.6g})",
                        worst.value, worst.center.x, worst.center.y, worst.center.z);
  }
  return "the mesh misses what was asked for; it was written nevertheless:" + text + place +
         "\n  remedy: a larger improve.target_angle, smaller sizes there, or lower limits";
}

}  // namespace aeroloom::pipeline
