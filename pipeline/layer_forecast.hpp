/// What boundary layers a run would have, from sizes and distances between faces alone.
#pragma once

#include "cad/model/model.hpp"
#include "layers/columns.hpp"
#include "mesh/data/patch.hpp"
#include "pipeline/case/case.hpp"
#include "sizing/field/size_field.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

/// The layers of a patch. Areas in the unit of the model, squared.
struct PatchLayerForecast {
  std::string name;
  layers::WallLayers asked;
  std::int32_t least_count = 0, most_count = 0;  ///< of layers wanted
  double least_total = 0, most_total = 0;        ///< their heights together
  double cells = 0;
  double area = 0;
  double compressed_area = 0;  ///< where gaps are too narrow for the total: layers grow slower
  double lacking_area = 0;     ///< where they do not hold so many layers of the first height
  double narrowest_gap = std::numeric_limits<double>::infinity();  ///< of those
  geometry::Vec3 narrowest_at = {};                                ///< on the wall
};

struct LayerForecast {
  std::vector<PatchLayerForecast> patches;  ///< those with layers
  std::optional<double> reynolds, length;   ///< of the flow, where the case tells
  int cells_of_prism = 1;                   ///< that each becomes
  /// What layers add to a run: cells, seconds of one core, bytes of memory, all ranks together.
  double cells() const;
  double seconds() const;
  double bytes() const;
};

/// Layers wanted follow from the sizes; gaps are what a line along the normal meets first, so that walls
/// which meet at an edge count as far as they face each other. What else keeps layers away (bad cells,
/// neighbours with fewer) only a run finds. Not collective. Throws std::invalid_argument as
/// cases::layer_options().
LayerForecast forecast_layers(const cad::Model& model, const std::vector<mesh::PatchType>& types,
                              const cases::Case& input, const sizing::SizeField& field);

/// Lines for people; empty where no patch has layers.
std::string describe(const LayerForecast& forecast);
nlohmann::ordered_json to_json(const LayerForecast& forecast);

}  // namespace aeroloom::pipeline
