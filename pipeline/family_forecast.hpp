/// Predicts the meshes of a family: one case at several values of `sizing.scale`.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/patch.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

/// The levels to predict. Sizes of each are `ratio` times as small as those of the level before; the first
/// level is the case itself.
struct FamilyRequest {
  std::int64_t levels = 0;  ///< 0: none
  double ratio = 1.5;       ///< above 0; below 1 levels become coarser
};
inline constexpr std::int64_t most_family_levels = 10;

/// One mesh of the family.
struct FamilyLevel {
  double scale = 1;                 ///< value of `sizing.scale`, as it is printed
  double minimum = 0, maximum = 0;  ///< sizes
  sizing::PredictedCounts counts;   ///< tetrahedra off the layers
  double layer_cells = 0;           ///< 0 without layers
  double first = 0, total = 0;      ///< of the layers: lowest first height, greatest total; 0 without layers
  std::optional<double> y_plus_node;  ///< of that first height; empty where the flow is not known
  double seconds = 0;                 ///< of one core, layers included
  double bytes = 0;                   ///< of memory, all ranks together, layers included
};

/// The scales of the levels, rounded to six digits. Throws std::invalid_argument for a ratio of 1, and where
/// a level's scale is not possible, with a remedy.
std::vector<double> scales_of(const FamilyRequest& family, const cases::Case& input);

/// Forecasts for the scales, from the sized domain of the case. Sizes of a family are similar, so counts
/// follow exactly; layers are counted anew. `types`: by patch of the model. Not collective.
std::vector<FamilyLevel> forecast_family(const std::vector<double>& scales, const domain::SizedDomain& sized,
                                         const std::vector<mesh::PatchType>& types, const cases::Case& input,
                                         int ranks);

/// A table; empty without levels.
std::string describe(const std::vector<FamilyLevel>& family);
nlohmann::ordered_json to_json(const std::vector<FamilyLevel>& family);

}  // namespace aeroloom::pipeline
