#include "pipeline/domain/unresolved_features.hpp"

#include "geometry/place_text.hpp"
#include "sizing/choice/narrow_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

/// Triangles that are longer than wide by less have angles above the 28 degrees that improvement aims at.
constexpr double least_listed_aspect = 1.9;

}  // namespace

FeatureReport report_features(const sizing::SampledModel& sampled,
                              const sizing::FeatureResolution& resolution, double tetrahedra) {
  FeatureReport report{resolution, tetrahedra, {}};
  if (!resolution.limited || resolution.aspect < least_listed_aspect) return report;
  const double widest = resolution.minimum / least_listed_aspect;
  for (const sizing::NarrowRegion& region :
       sizing::narrow_regions_below(sampled, widest, resolution.minimum)) {
    report.regions.push_back({sampled.model().face(region.face).name, region.width, region.place,
                              std::atan(1 / resolution.aspect_at(region.width)) * 180 / std::numbers::pi});
  }
  return report;
}

double FeatureReport::wanted_tetrahedra() const {
  if (regions.empty()) return tetrahedra;
  return tetrahedra * resolution.resolved_ratio / resolution.ratio;
}

std::string describe_added(const FeatureReport& report) {
  constexpr double least_logged_ratio = 1.25;  // less is what a forecast may be off by
  if (report.resolution.ratio < least_logged_ratio) return {};
  return fmt::format(
      "features finer than the smallest size make it {:.2g} times as many: about {:.2g} "
      "tetrahedra (sizing.feature_budget, sizing.feature_minimum bound them)",
      report.resolution.ratio, report.tetrahedra);
}

std::string describe(const FeatureReport& report) {
  if (report.regions.empty()) return {};
  const UnresolvedRegion& narrowest = report.regions.front();
  return fmt::format(
      "{} face(s) have narrow regions that {:.3g} tetrahedra do not resolve, the narrowest '{}', {:.3g} wide "
      "at {}, with angles from about {:.2g} degrees. Remedy: a larger sizing.target_tetrahedra (about {:.2g} "
      "resolve all) or sizing.feature_budget, or geometry.trailing_edges: sharpen",
      report.regions.size(), report.tetrahedra, narrowest.face, narrowest.width,
      geometry::place_text(narrowest.place), narrowest.surface_degrees, report.wanted_tetrahedra());
}

}  // namespace aeroloom::domain
