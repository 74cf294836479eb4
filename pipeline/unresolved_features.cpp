#include "pipeline/unresolved_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

constexpr std::size_t shown_strips = 5;

}  // namespace

FeatureReport report_features(const sizing::ModelSampler& sampler, const sizing::FeatureShare& share,
                              double tetrahedra) {
  FeatureReport report{share, tetrahedra, {}};
  if (!share.limited) return report;
  for (const sizing::Strip& strip : sampler.strips_narrower_than(share.floor, share.minimum)) {
    report.strips.push_back({sampler.model().face(strip.face).name, strip.width, strip.place,
                             std::atan(strip.width / share.floor) * 180 / std::numbers::pi});
  }
  return report;
}

double FeatureReport::wanted_tetrahedra() const {
  if (strips.empty()) return tetrahedra;
  return tetrahedra * share.gap_share * share.resolved_share / share.share;
}

std::string describe_share(const FeatureReport& report) {
  constexpr double telling = 1.25;
  if (report.share.share < telling) return {};
  return fmt::format(
      "features finer than the smallest size make it {:.2g} times as many: about {:.2g} "
      "tetrahedra (sizing.feature_budget, sizing.feature_minimum bound them)",
      report.share.share, report.tetrahedra);
}

std::string describe(const FeatureReport& report) {
  if (report.strips.empty()) return {};
  std::string text = fmt::format(
      "{} face(s) have strips narrower than {:.3g}, the smallest size that features get for {:.3g} "
      "tetrahedra; resolved, they would take about {:.2g}. Triangles along them are longer than wide:",
      report.strips.size(), report.share.floor, report.tetrahedra, report.wanted_tetrahedra());
  for (std::size_t i = 0; i < std::min(shown_strips, report.strips.size()); ++i) {
    const UnresolvedStrip& strip = report.strips[i];
    text += fmt::format(" '{}' is {:.3g} wide at ({:.6g}, {:.6g}, {:.6g}), angles from about {:.2g} degrees;",
                        strip.face, strip.width, strip.place.x, strip.place.y, strip.place.z,
                        strip.surface_degrees);
  }
  if (report.strips.size() > shown_strips)
    text += fmt::format(" and {} more;", report.strips.size() - shown_strips);
  return text +
         " remedies: geometry.trailing_edges: sharpen, where they are blunt trailing edges; a larger "
         "sizing.feature_budget; a larger sizing.target_tetrahedra; or edges that are sharp, or thicker, in "
         "the "
         "CAD";
}

nlohmann::ordered_json to_json(const FeatureReport& report) {
  auto strips = nlohmann::ordered_json::array();
  for (const UnresolvedStrip& strip : report.strips) {
    strips.push_back({{"face", strip.face},
                      {"width", strip.width},
                      {"at", to_json(strip.place)},
                      {"surface_degrees", strip.surface_degrees}});
  }
  return {{"smallest_size", report.share.floor},
          {"share", report.share.share},
          {"smallest_gap_size", report.share.gap_floor},
          {"gap_share", report.share.gap_share},
          {"predicted_tetrahedra", report.tetrahedra},
          {"wanted_tetrahedra", report.wanted_tetrahedra()},
          {"unresolved", std::move(strips)}};
}

}  // namespace aeroloom::pipeline
