#include "pipeline/level_forecast.hpp"

#include "parallel/observation/process_memory.hpp"
#include "pipeline/forecast.hpp"

#include <cmath>

#include <fmt/format.h>

namespace aeroloom::pipeline {

std::vector<LevelForecast> forecast_levels(sizing::Level level, const sizing::PredictedCounts& counted,
                                           const cases::SizingRequest& request, int ranks) {
  const auto factor = [&](sizing::Level of) { return sizing::sizes_of(of, request.family).factor; };
  std::vector<LevelForecast> forecasts;
  for (const sizing::Level each : sizing::levels_like(level)) {
    const double finer = factor(level) / factor(each);
    const sizing::PredictedCounts counts{counted.triangles * std::pow(finer, 2),
                                         counted.tetrahedra * std::pow(finer, 3)};
    forecasts.push_back({each, counts, predicted_seconds(counts), predicted_bytes(counts, ranks)});
  }
  return forecasts;
}

std::string describe(const domain::LevelFindings& found) {
  std::string text = fmt::format(
      "level: reference chord {:.4g}, semispan {:.4g}, at most {:.3g} on walls, far field {:.3g} semispans "
      "away\n"
      "       {:<32} {:>9} {:>9} {:>19} {:>9}\n",
      found.reference_chord, found.semispan, found.wall_size, found.far_field, "trailing edge", "length",
      "width", "chord", "size");
  for (const domain::FoundTrailingEdge& edge : found.edges)
    text += fmt::format("       {:<32} {:>9.4g} {:>9} {:>19} {:>9.3g}\n", edge.faces, edge.length,
                        edge.is_blunt ? fmt::format("{:.3g}", edge.width) : "sharp",
                        fmt::format("{:.4g} to {:.4g}", edge.shortest_chord, edge.longest_chord),
                        edge.smallest_size);
  return text;
}

nlohmann::ordered_json to_json(const domain::LevelFindings& found) {
  nlohmann::ordered_json json = {{"reference_chord", found.reference_chord},
                                 {"semispan", found.semispan},
                                 {"wall_size", found.wall_size},
                                 {"far_field_semispans", found.far_field}};
  auto& edges = json["trailing_edges"] = nlohmann::ordered_json::array();
  for (const domain::FoundTrailingEdge& edge : found.edges)
    edges.push_back({{"faces", edge.faces},
                     {"length", edge.length},
                     {"width", edge.width},
                     {"shortest_chord", edge.shortest_chord},
                     {"longest_chord", edge.longest_chord},
                     {"smallest_size", edge.smallest_size}});
  return json;
}

std::string describe(const std::vector<LevelForecast>& levels) {
  if (levels.empty()) return {};
  std::string text = fmt::format("levels: {:<8} {:>12} {:>12} {:>14} {:>8}\n", "level", "triangles",
                                 "tetrahedra", "s on one core", "GiB");
  for (const LevelForecast& each : levels)
    text += fmt::format("        {:<8} {:>12.3g} {:>12.3g} {:>14.2g} {:>8.2g}\n", sizing::name_of(each.level),
                        each.counts.triangles, each.counts.tetrahedra, each.seconds,
                        each.bytes / parallel::gibibyte);
  return text;
}

nlohmann::ordered_json to_json(const std::vector<LevelForecast>& levels) {
  auto json = nlohmann::ordered_json::array();
  for (const LevelForecast& each : levels)
    json.push_back({{"level", sizing::name_of(each.level)},
                    {"triangles", each.counts.triangles},
                    {"tetrahedra", each.counts.tetrahedra},
                    {"seconds_on_one_core", each.seconds},
                    {"bytes", each.bytes}});
  return json;
}

}  // namespace aeroloom::pipeline
