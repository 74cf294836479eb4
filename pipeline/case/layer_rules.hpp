/// The boundary layers that a case asks for.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/patch.hpp"
#include "sizing/choice/levels.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Layers of one patch that differ from the others. Members left out are as for all patches.
struct LayerRule {
  std::string name;  ///< of the patch
  std::optional<double> first, growth, total;
  std::optional<std::int64_t> constant, count;         ///< count 0: no layers
  layers::InnerSides side = layers::InnerSides::none;  ///< of faces between regions and of baffles
  std::string where = {};                              ///< place in the case, for messages: "case.yaml:7:3"
};

/// The patches that get layers by default.
enum class LayeredWalls : std::uint8_t { all, none };
/// What ends columns that neither a count nor a total height ends.
enum class LayerEnd : std::uint8_t { isotropic };
/// What is changed where count and total end layers early: nothing, the growth, or count and total.
enum class LayerFit : std::uint8_t { none, growth, count };

/// Limits that layers must meet for the run to succeed. Empty members are not checked.
struct LayerGate {
  bool given = false;
  std::optional<double> full_area;  ///< smallest fraction of the wall area with all layers
};

/// The layers asked for; lengths in the model's unit.
struct LayerRequest {
  bool given = false;  ///< whether the case asks for layers
  LayeredWalls walls = LayeredWalls::all;
  std::optional<double> first;   ///< height of the first layer
  bool first_of_level = false;   ///< the first height comes from the y+ of the level of sizes
  std::optional<double> y_plus;  ///< the first height is computed from it; left out: that of the level
  std::optional<double> reynolds, length;
  std::optional<std::int64_t> constant;  ///< left out: that of the level, or 2
  std::optional<double> growth;          ///< left out: that of the level, or 1.2
  double growth_maximum = 1.3;           ///< of the growth that follows from count and total, or from `fit`
  std::optional<std::int64_t> count;
  std::optional<double> total;
  LayerEnd until = LayerEnd::isotropic;
  LayerFit fit = LayerFit::none;
  layers::LayerElements elements = layers::LayerElements::prisms;
  layers::FanPlaces fans = layers::FanPlaces::all;
  LayerGate gate;
  std::vector<LayerRule> patches;
};

/// Height of the first layer for a given y+ at the Reynolds number Re of the length L: 0.80 y+ L / (Re
/// sqrt(cf / 2)), cf = 0.026 / Re^(1/7). It agrees with the tables of the prediction workshops. For
/// cell-centred solvers y+ is that of the cell's centre: the height is doubled.
double first_height(double y_plus, double reynolds, double length, sizing::SolverPoints points);

/// Of a turbulent boundary layer on a flat plate at the length L: 0.37 L / Re^(1/5) (Schlichting and Gersten,
/// Boundary-Layer Theory, section 2.3).
double boundary_layer_thickness(double reynolds, double length);

/// The inverse: y+ of a first height, for a vertex-centred solver.
double y_plus_of(double first, double reynolds, double length);

struct SizingRequest;

/// The layers that the case asks for on a wall, at the scale of the sizes; by `rule` where the patch has one,
/// else as on all walls. Where a count and a total are given and no growth, neither by a level, the growth
/// follows from them.
layers::WallLayers wanted_layers(const LayerRequest& request, const SizingRequest& sizing,
                                 const LayerRule* rule = nullptr);

/// Where the count or total of layers ends them before the last is half as high as meets sizes over edges of
/// this length: "30 layers end at 0.011, ...; 47 are needed". Else empty.
std::string early_end(const layers::WallLayers& asked, double edge);

/// The layers asked for, changed where early_end() tells of them over edges of this mean length. `growth`:
/// one that is larger, at most `growth_maximum`, so that the last of `count` layers meets the sizes; no
/// total. Without a count it is the number of layers that the total holds. `count`: neither count nor total.
/// Layers that do not grow stay.
layers::WallLayers fitted_layers(const layers::WallLayers& asked, double edge, LayerFit fit,
                                 double growth_maximum);

/// What the change was: "growth 1.27 for 1.2, so that 30 layers end isotropic". Empty if there was none.
std::string change_of_fit(const layers::WallLayers& asked, const layers::WallLayers& fitted, double edge);

/// The layers of each patch. Throws std::invalid_argument, with the place in the case, for a rule whose patch
/// does not exist (with the nearest name) or is no wall.
layers::LayerOptions layer_options(const LayerRequest& request, const SizingRequest& sizing,
                                   const std::vector<std::string>& patches,
                                   const std::vector<mesh::PatchType>& types);

/// The request without rules for patches that are not in the list.
LayerRequest without_missing_patches(LayerRequest request, const std::vector<std::string>& patches);

}  // namespace aeroloom::cases
