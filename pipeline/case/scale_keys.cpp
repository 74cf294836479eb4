#include "pipeline/case/scale_keys.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// Largest values of `sizing.growth` and of `layers.growth`.
constexpr double most_size_growth = 3, most_layer_growth = 2;
constexpr double least_scale = 0.01, most_scale = 100;  // chosen: a million times as many or as few elements

std::string fault_of_growth(const std::string& key, double growth, double most, double scale) {
  const double scaled = std::pow(growth, scale);
  if (scaled <= most) return {};
  return fmt::format(
      "'sizing.scale' is {:.6g}: '{}', {:.4g}, to that power is {:.3g}, and neighbours may differ by at most "
      "{:g}. Remedy: a scale of at most {:.3g}, or a growth nearer to 1",
      scale, key, growth, scaled, most, std::log(most) / std::log(growth));
}

/// With the growth that holds where the case gives none.
double growth_of_sizes(const SizingRequest& sizing) {
  if (sizing.growth) return *sizing.growth;
  if (sizing.level) return sizing::sizes_of(*sizing.level, sizing.family, sizing.solver).growth;
  return sizing::SizingOptions{}.growth;
}

double growth_of_layers(const SizingRequest& sizing, const LayerRequest& layers) {
  if (layers.growth) return *layers.growth;
  return sizing.level ? sizing::layers_of(*sizing.level, sizing.family).growth : layers::WallLayers{}.growth;
}

}  // namespace

void declare_scale(KeyTable& keys, SizingRequest& request) {
  keys.number(
      "scale", request.scale, Range::between(least_scale, most_scale),
      "Factor on all sizes, those chosen from the model and heights of layers included: a family of "
      "similar meshes from one case ([Grid families](configuration/sizing.md#grid-families)). Sizes are "
      "chosen as with 1 and then multiplied, so that target and budget hold for 1.");
}

bool is_scale(double scale) {
  return scale >= least_scale && scale <= most_scale;
}

std::string fault_of_scale(const SizingRequest& sizing, const LayerRequest& layers, double scale) {
  std::string fault = fault_of_growth("sizing.growth", growth_of_sizes(sizing), most_size_growth, scale);
  if (!fault.empty() || !layers.given) return fault;
  fault = fault_of_growth("layers.growth", growth_of_layers(sizing, layers), most_layer_growth, scale);
  for (const LayerRule& rule : layers.patches) {
    if (!fault.empty()) break;
    if (rule.growth)
      fault =
          fault_of_growth("layers.patches." + rule.name + ".growth", *rule.growth, most_layer_growth, scale);
  }
  return fault;
}

void check_scale(const KeyTable& keys, const CaseDraft& draft) {
  const double scale = draft.result.sizing.scale;
  if (scale <= 1) return;
  LayerRequest layers = draft.result.layers;
  layers.given = layers.given || !draft.layer_rules.empty();
  layers.patches.assign(draft.layer_rules.begin(), draft.layer_rules.end());
  const std::string fault = fault_of_scale(draft.result.sizing, layers, scale);
  if (!fault.empty()) throw CaseError(keys.where("sizing.scale") + ": " + fault);
}

}  // namespace aeroloom::cases
