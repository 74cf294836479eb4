/// Predicts the boundary layers of a run from sizes and distances between faces.
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

/// The layers of a patch. Areas are in the square of the model's unit.
struct PatchLayerForecast {
  std::string name;
  layers::WallLayers asked;                      ///< as `layers.fit` has changed it
  std::int32_t least_count = 0, most_count = 0;  ///< number of layers wanted
  double least_total = 0, most_total = 0;        ///< total height wanted
  double cells = 0;
  double replaced = 0;  ///< tetrahedra that sizes would make where the layers are
  double area = 0;
  double edges_area = 0;    ///< sum of areas times sizes
  double lacking_area = 0;  ///< gaps do not hold the wanted number of layers
  double narrowest_gap = std::numeric_limits<double>::infinity();  ///< of the areas above
  geometry::Vec3 narrowest_at = {};                                ///< point on the wall
  std::string change;                                              ///< by `layers.fit`; empty: none
};

struct LayerForecast {
  std::vector<PatchLayerForecast> patches;  ///< patches with layers
  std::optional<double> reynolds, length;   ///< of the flow, if the case has them
  int cells_of_prism = 1;                   ///< cells that a prism is divided into
  /// What layers add to a run: cells, seconds of one core, bytes of memory of all ranks together.
  double cells() const;
  double seconds() const;
  double bytes() const;
  /// Of the tetrahedra that sizes make in the whole fluid, those that are left off the layers.
  double tetrahedra_off_layers(double everywhere) const;
};

/// The wanted layers, and the sectors over sharp CAD edges, follow from the sizes. A gap is the distance
/// along the normal to the first wall; walls that meet at an edge count where they face each other. Other
/// limits (invalid cells, stairs) are known only in a run. Not collective. Throws std::invalid_argument as
/// cases::layer_options().
LayerForecast forecast_layers(const cad::Model& model, const std::vector<mesh::PatchType>& types,
                              const cases::Case& input, const sizing::SizeField& field);

/// Lines of text; empty if no patch has layers.
std::string describe(const LayerForecast& forecast);
nlohmann::ordered_json to_json(const LayerForecast& forecast);

}  // namespace aeroloom::pipeline
