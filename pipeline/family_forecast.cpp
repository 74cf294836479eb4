#include "pipeline/family_forecast.hpp"

#include "parallel/observation/process_memory.hpp"
#include "pipeline/case/layer_rules.hpp"
#include "pipeline/case/scale_keys.hpp"
#include "pipeline/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// What a user who types what is printed gets.
double as_printed(double scale) {
  return std::stod(fmt::format("{:.6g}", scale));
}

void add_layers(const LayerForecast& layers, FamilyLevel& level) {
  level.layer_cells = layers.cells();
  level.counts.tetrahedra = layers.tetrahedra_off_layers(level.counts.tetrahedra);
  level.seconds += layers.seconds();
  level.bytes += layers.bytes();
  for (const PatchLayerForecast& patch : layers.patches) {
    level.first = level.first > 0 ? std::min(level.first, patch.asked.first) : patch.asked.first;
    level.total = std::max(level.total, patch.most_total);
  }
  if (layers.reynolds && layers.length && level.first > 0)
    level.y_plus_node = cases::y_plus_of(level.first, *layers.reynolds, *layers.length);
}

}  // namespace

std::vector<double> scales_of(const FamilyRequest& family, const cases::Case& input) {
  if (family.levels == 0) return {};
  if (!(family.ratio > 0) || !std::isfinite(family.ratio) || family.ratio == 1)
    throw std::invalid_argument(fmt::format(
        "--ratio is {:g}, and all levels would be one mesh or none. Remedy: a ratio above 1 for finer "
        "levels, such as 1.5, or below 1 for coarser ones",
        family.ratio));
  std::vector<double> scales{input.sizing.scale};
  while (static_cast<std::int64_t>(scales.size()) < family.levels) {
    const double scale =
        as_printed(input.sizing.scale / std::pow(family.ratio, static_cast<double>(scales.size())));
    if (!cases::is_scale(scale))
      throw std::invalid_argument(
          fmt::format("--levels {} --ratio {:g}: sizing.scale would be {:g}, outside of "
                      "what it accepts. Remedy: fewer levels, or a ratio nearer to 1",
                      family.levels, family.ratio, scale));
    const std::string fault = cases::fault_of_scale(input.sizing, input.layers, scale);
    if (!fault.empty())
      throw std::invalid_argument(
          fmt::format("--levels {} --ratio {:g}: {}", family.levels, family.ratio, fault));
    scales.push_back(scale);
  }
  return scales;
}

std::vector<FamilyLevel> forecast_family(const std::vector<double>& scales, const domain::SizedDomain& sized,
                                         const std::vector<mesh::PatchType>& types, const cases::Case& input,
                                         int ranks) {
  std::vector<FamilyLevel> family;
  for (const double scale : scales) {
    const double factor = scale / input.sizing.scale;
    const sizing::SizingOptions sizes = sizing::at_scale(sized.sizes, factor);
    FamilyLevel level{scale, sizes.minimum, sizes.maximum, sizing::at_scale(sized.findings.counts, factor)};
    if (input.layers.given) {
      cases::Case of_level = input;
      of_level.sizing.scale = scale;
      add_layers(forecast_layers(sized.model, types, of_level, sized.field.scaled(factor)), level);
    }
    level.seconds += predicted_seconds(level.counts);
    level.bytes += predicted_bytes(level.counts, ranks);
    family.push_back(level);
  }
  return family;
}

std::string describe(const std::vector<FamilyLevel>& family) {
  if (family.empty()) return {};
  const bool has_layers = std::any_of(family.begin(), family.end(),
                                      [](const FamilyLevel& level) { return level.layer_cells > 0; });
  const auto of_layers = [&](const std::string& text) { return has_layers ? text : std::string(); };
  std::string text =
      fmt::format("family: {:>12} {:>9} {:>9} {:>10} {:>10} {}{:>13} {:>7}\n", "sizing.scale", "smallest",
                  "largest", "triangles", "tetrahedra",
                  of_layers(fmt::format("{:>10} {:>9} {:>8} {:>9} ", "in layers", "first", "y+", "total")),
                  "s on one core", "GiB");
  for (const FamilyLevel& level : family)
    text += fmt::format(
        "        {:>12.6g} {:>9.3g} {:>9.3g} {:>10.3g} {:>10.3g} {}{:>13.2g} {:>7.2g}\n", level.scale,
        level.minimum, level.maximum, level.counts.triangles, level.counts.tetrahedra,
        of_layers(fmt::format("{:>10.3g} {:>9.3g} {:>8} {:>9.3g} ", level.layer_cells, level.first,
                              level.y_plus_node ? fmt::format("{:.3g}", *level.y_plus_node) : "-",
                              level.total)),
        level.seconds, level.bytes / parallel::gibibyte);
  return text;
}

nlohmann::ordered_json to_json(const std::vector<FamilyLevel>& family) {
  auto json = nlohmann::ordered_json::array();
  for (const FamilyLevel& level : family)
    json.push_back({{"scale", level.scale},
                    {"minimum", level.minimum},
                    {"maximum", level.maximum},
                    {"triangles", level.counts.triangles},
                    {"tetrahedra", level.counts.tetrahedra},
                    {"layer_cells", level.layer_cells},
                    {"layer_first", level.first},
                    {"layer_total", level.total},
                    {"y_plus_node", level.y_plus_node ? nlohmann::ordered_json(*level.y_plus_node)
                                                      : nlohmann::ordered_json()},
                    {"seconds_on_one_core", level.seconds},
                    {"bytes", level.bytes}});
  return json;
}

}  // namespace aeroloom::pipeline
