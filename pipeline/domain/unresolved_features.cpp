#include "pipeline/domain/unresolved_features.hpp"

#include "geometry/place_text.hpp"
#include "sizing/choice/narrow_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

constexpr std::size_t shown_strips = 5;  // in a line of the log; the report has all
/// Triangles that are longer than wide by less have angles above the 28 degrees that improvement aims at.
constexpr double telling_aspect = 1.9;

}  // namespace

FeatureReport report_features(const sizing::SampledModel& sampled, const sizing::FeatureResolution& share,
                              double tetrahedra) {
  FeatureReport report{share, tetrahedra, {}};
  if (!share.limited || share.aspect < telling_aspect) return report;
  const double widest = share.minimum / telling_aspect;
  for (const sizing::NarrowRegion& strip : sizing::narrow_regions_below(sampled, widest, share.minimum)) {
    report.strips.push_back({sampled.model().face(strip.face).name, strip.width, strip.place,
                             std::atan(1 / share.aspect_at(strip.width)) * 180 / std::numbers::pi});
  }
  return report;
}

double FeatureReport::wanted_tetrahedra() const {
  if (strips.empty()) return tetrahedra;
  return tetrahedra * share.gap_ratio * share.resolved_ratio / share.ratio;
}

std::string describe_share(const FeatureReport& report) {
  constexpr double telling = 1.25;  // less is what a forecast may be off by
  if (report.share.ratio < telling) return {};
  return fmt::format(
      "features finer than the smallest size make it {:.2g} times as many: about {:.2g} "
      "tetrahedra (sizing.feature_budget, sizing.feature_minimum bound them)",
      report.share.ratio, report.tetrahedra);
}

std::string describe(const FeatureReport& report) {
  if (report.strips.empty()) return {};
  const std::string longer = report.share.aspect == sizing::no_aspect
                                 ? fmt::format("{:.3g} long", report.share.minimum)
                                 : fmt::format("{:.2g} times as long as wide", report.share.aspect);
  std::string text = fmt::format(
      "{} face(s) have strips that {:.3g} tetrahedra do not resolve: triangles along them are {}; resolved, "
      "they would take about {:.2g}:",
      report.strips.size(), report.tetrahedra, longer, report.wanted_tetrahedra());
  for (std::size_t i = 0; i < std::min(shown_strips, report.strips.size()); ++i) {
    const UnresolvedStrip& strip = report.strips[i];
    text += fmt::format(" '{}' is {:.3g} wide at {}, angles from about {:.2g} degrees;", strip.face,
                        strip.width, geometry::place_text(strip.place), strip.surface_degrees);
  }
  if (report.strips.size() > shown_strips)
    text += fmt::format(" and {} more;", report.strips.size() - shown_strips);
  return text +
         " remedies: geometry.trailing_edges: sharpen, where they are blunt trailing edges; a larger "
         "sizing.feature_budget; a larger sizing.target_tetrahedra; or edges that are sharp, or thicker, in "
         "the "
         "CAD";
}

}  // namespace aeroloom::domain
