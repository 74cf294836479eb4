#include "pipeline/report/parts_json.hpp"

#include <string>
#include <utility>

namespace aeroloom::report {
namespace {

double fraction(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

/// Areas by what limits the layers there, those that are limited.
Json limits_json(const layers::PatchLayers& patch) {
  Json json = Json::object();
  for (const layers::LayerLimit limit : layers::all_layer_limits) {
    const double area = patch.limited_area[static_cast<std::size_t>(limit)];
    if (limit != layers::LayerLimit::none && area > 0)
      json[std::string(layers::name_of(limit))] = fraction(area, patch.area);
  }
  return json;
}

Json patch_json(const std::string& name, layers::InnerSides sides, const layers::WallLayers& asked,
                const layers::PatchLayers& patch) {
  Json json = {{"name", name},
               {"side", layers::name_of(sides)},
               {"first", asked.first},
               {"growth", asked.growth},
               {"constant", asked.constant},
               {"count", asked.count > 0 ? Json(asked.count) : Json()},
               {"total", asked.total > 0 ? Json(asked.total) : Json()},
               {"area", patch.area},
               {"full", fraction(patch.full_area, patch.area)},
               {"partial", fraction(patch.partial_area, patch.area)},
               {"empty", fraction(patch.empty_area, patch.area)},
               {"isotropic", fraction(patch.isotropic_area, patch.area)},
               {"low_first", fraction(patch.low_first_area, patch.area)},
               {"layers_mean", fraction(patch.sums.layers, patch.area)},
               {"layers_wanted_mean", fraction(patch.sums.wanted, patch.area)},
               {"layers_max", patch.most_layers},
               {"height_mean", fraction(patch.sums.heights, patch.area)},
               {"last_mean", fraction(patch.sums.last, patch.area)},
               {"prisms", patch.prisms},
               {"hexahedra", patch.hexahedra},
               {"pyramids", patch.pyramids},
               {"tetrahedra", patch.tetrahedra}};
  json["limited"] = limits_json(patch);
  return json;
}

}  // namespace

Json layers_json(const RunRecord& record) {
  if (!record.layers) return {};
  const layers::LayerReport& report = record.layers->report;
  double area = 0, full = 0, empty = 0, low_first = 0;
  Json patches = Json::array();
  for (std::size_t p = 0; p < report.patches.size(); ++p) {
    const layers::WallLayers& asked = record.layers->asked.patches.at(p);
    if (asked.first <= 0) continue;
    const layers::PatchLayers& patch = report.patches[p];
    area += patch.area, full += patch.full_area, empty += patch.empty_area;
    low_first += patch.low_first_area;
    patches.push_back(
        patch_json(record.patches.at(p).name, layers::inner_sides_of(record.layers->asked, p), asked, patch));
  }
  return {{"full", fraction(full, area)},
          {"empty", fraction(empty, area)},
          {"low_first", fraction(low_first, area)},
          {"boundary_layer", record.layers->boundary_layer ? Json(*record.layers->boundary_layer) : Json()},
          {"validity_rounds", report.validity_rounds},
          {"crossing_rounds", report.crossing_rounds},
          {"crossings", report.crossings},
          {"swallowing", report.enclosing},
          {"emptied_last", report.zeroed_by_force},
          {"patches", std::move(patches)}};
}

}  // namespace aeroloom::report
