#include "pipeline/domain/unresolved_features.hpp"

#include "geometry/place_text.hpp"
#include "sizing/choice/narrow_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

constexpr std::size_t shown_regions = 5;  // in a line of the log; the report has all
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
  return tetrahedra * resolution.gap_ratio * resolution.resolved_ratio / resolution.ratio;
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
  const std::string longer = report.resolution.aspect == sizing::no_aspect
                                 ? fmt::format("{:.3g} long", report.resolution.minimum)
                                 : fmt::format("{:.2g} times as long as wide", report.resolution.aspect);
  std::string text = fmt::format(
      "{} face(s) have narrow regions that {:.3g} tetrahedra do not resolve: triangles along them are {}; "
      "resolved, "
      "they would take about {:.2g}:",
      report.regions.size(), report.tetrahedra, longer, report.wanted_tetrahedra());
  for (std::size_t i = 0; i < std::min(shown_regions, report.regions.size()); ++i) {
    const UnresolvedRegion& region = report.regions[i];
    text += fmt::format(" '{}' is {:.3g} wide at {}, angles from about {:.2g} degrees;", region.face,
                        region.width, geometry::place_text(region.place), region.surface_degrees);
  }
  if (report.regions.size() > shown_regions)
    text += fmt::format(" and {} more;", report.regions.size() - shown_regions);
  return text +
         " remedies: geometry.trailing_edges: sharpen, where they are blunt trailing edges; a larger "
         "sizing.feature_budget; a larger sizing.target_tetrahedra; or edges that are sharp, or thicker, in "
         "the "
         "CAD";
}

}  // namespace aeroloom::domain
