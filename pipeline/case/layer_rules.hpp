/// What the case says of boundary layers.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/patch.hpp"
#include "sizing/choice/levels.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// The layers of a patch that has other ones than the rest; what is left out is as for all.
struct LayerRule {
  std::string name;  ///< of the patch
  std::optional<double> first, growth, total;
  std::optional<std::int64_t> constant, count;  ///< count 0: no layers
};

/// The patches that get layers without being named.
enum class LayeredWalls : std::uint8_t { all, none };
/// What stops columns that no count and no total stops.
enum class LayerEnd : std::uint8_t { isotropic };

/// What layers have to attain for the run to count as a success; what is empty is not asked for.
struct LayerGate {
  bool given = false;
  std::optional<double> full_area;  ///< the part of the walls that has all layers asked for, at least
};

/// The layers asked for; lengths in the model's unit.
struct LayerRequest {
  bool given = false;  ///< whether any are asked for: a height, or a patch
  LayeredWalls walls = LayeredWalls::all;
  std::optional<double> first;   ///< height of the first layer
  bool first_of_level = false;   ///< or it comes from the level of sizes, by its y+
  std::optional<double> y_plus;  ///< or what it is computed from; left out: that of the level of sizes
  std::optional<double> reynolds, length;
  std::optional<std::int64_t> constant;  ///< left out: that of the level, or 2
  std::optional<double> growth;          ///< left out: that of the level, or 1.2
  std::optional<std::int64_t> count;
  std::optional<double> total;
  LayerEnd until = LayerEnd::isotropic;
  layers::LayerElements elements = layers::LayerElements::prisms;
  LayerGate gate;
  std::vector<LayerRule> patches;
};

/// The height of the first layer from y+ at a Reynolds number of a length: 0.80 y+ L / (Re sqrt(cf / 2)) with
/// cf = 0.026 / Re^(1/7), which meets the tables of the prediction workshops. Solvers with their unknowns in
/// cells mean its centre: twice as high.
double first_height(double y_plus, double reynolds, double length, sizing::SolverPoints points);

/// Flow units (y+) of a height of the first layer: the inverse, for a solver with its unknowns at vertices.
double y_plus_of(double first, double reynolds, double length);

struct SizingRequest;

/// The layers of each patch. Throws std::invalid_argument for a rule of a patch that there is not, with the
/// nearest name, or that is no wall.
layers::LayerOptions layer_options(const LayerRequest& request, const SizingRequest& sizing,
                                   const std::vector<std::string>& patches,
                                   const std::vector<mesh::PatchType>& types);

}  // namespace aeroloom::cases
