#include "pipeline/case/layer_rules.hpp"

#include "layers/column_heights.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/case/nearest_name.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

std::string place_of_rule(const LayerRule& rule) {
  return fmt::format("{}layers.patches.{}", rule.where.empty() ? "" : rule.where + ": ", rule.name);
}

/// What all walls get.
layers::WallLayers layers_of_walls(const LayerRequest& request, const SizingRequest& sizing) {
  std::optional<sizing::LevelLayers> level;
  if (sizing.level) level = sizing::layers_of(*sizing.level, sizing.family);
  layers::WallLayers wanted;
  if (request.first) wanted.first = *request.first;
  if (request.reynolds && request.length)
    wanted.first = first_height(request.y_plus.value_or(level ? level->y_plus : 1), *request.reynolds,
                                *request.length, sizing.solver);
  if (level && level->constant_layers > 0) wanted.constant = level->constant_layers;
  if (request.constant) wanted.constant = static_cast<std::int32_t>(*request.constant);
  wanted.growth = request.growth.value_or(level ? level->growth : wanted.growth);
  wanted.count = static_cast<std::int32_t>(request.count.value_or(0));
  wanted.total = request.total.value_or(0);
  return wanted;
}

layers::WallLayers layers_of_patch(const LayerRule& rule, layers::WallLayers wanted) {
  if (rule.count == 0) return {};
  if (rule.first) wanted.first = *rule.first;
  if (rule.growth) wanted.growth = *rule.growth;
  if (rule.constant) wanted.constant = static_cast<std::int32_t>(*rule.constant);
  if (rule.count) wanted.count = static_cast<std::int32_t>(*rule.count);
  if (rule.total) wanted.total = *rule.total;
  return wanted;
}

/// With the growth by which `count` layers are `total` high together.
layers::WallLayers with_growth_of_total(layers::WallLayers wanted, double growth_maximum) {
  const layers::Heights steepest{wanted.first, growth_maximum, wanted.constant};
  wanted.growth = layers::growth_of_total(steepest, wanted.count, wanted.total);
  return wanted;
}

/// The number of layers that take the place of `count` layers which are as many times higher.
std::int32_t count_at_scale(std::int32_t count, double scale) {
  const double scaled = std::round(count / scale);
  return static_cast<std::int32_t>(std::clamp<double>(scaled, 1, std::max(count, layers::most_layers)));
}

/// The layers of a mesh whose sizes are `scale` times as large: as high together, of as many fewer layers.
layers::WallLayers at_scale(layers::WallLayers wanted, double scale) {
  if (scale == 1 || wanted.first <= 0) return wanted;
  wanted.first *= scale;
  wanted.growth = std::pow(wanted.growth, scale);
  wanted.constant = count_at_scale(wanted.constant, scale);
  if (wanted.count > 0) wanted.count = count_at_scale(wanted.count, scale);
  return wanted;
}

std::size_t patch_of_rule(const LayerRule& rule, const std::vector<std::string>& patches,
                          const std::vector<mesh::PatchType>& types) {
  const auto found = std::find(patches.begin(), patches.end(), rule.name);
  const auto patch = static_cast<std::size_t>(found - patches.begin());
  if (found == patches.end()) {
    const std::optional<std::string> nearest = nearest_name(rule.name, patches);
    throw std::invalid_argument(
        fmt::format("{}: there is no such patch{}. Remedy: `aeroloom check` lists the patches",
                    place_of_rule(rule), nearest ? fmt::format("; the nearest name is '{}'", *nearest) : ""));
  }
  const bool inner = types.at(patch) == mesh::PatchType::interior;
  if (inner && rule.count != 0 && rule.side == layers::InnerSides::none)
    throw std::invalid_argument(fmt::format(
        "{}: this patch has cells on both sides, and the case does not say on which of them layers "
        "stand. Remedy: `side: front`, `back` or `both`, or no layers on it",
        place_of_rule(rule)));
  if (!inner && types.at(patch) != mesh::PatchType::wall && rule.count != 0)
    throw std::invalid_argument(
        fmt::format("{}: layers stand on walls, and this patch is of type {}. Remedy: "
                    "`patches: {{{}: {{type: wall}}}}`, or no layers on it",
                    place_of_rule(rule), mesh::name_of(types[patch]), rule.name));
  return patch;
}

}  // namespace

double first_height(double y_plus, double reynolds, double length, sizing::SolverPoints points) {
  constexpr double of_flat_plate = 0.80;  // meets the workshops' tables
  const double friction = 0.026 / std::pow(reynolds, 1.0 / 7);
  const double height = of_flat_plate * y_plus * length / (reynolds * std::sqrt(friction / 2));
  return points == sizing::SolverPoints::cell ? 2 * height : height;
}

double boundary_layer_thickness(double reynolds, double length) {
  constexpr double of_flat_plate = 0.37;
  return of_flat_plate * length / std::pow(reynolds, 0.2);
}

double y_plus_of(double first, double reynolds, double length) {
  return first / first_height(1, reynolds, length, sizing::SolverPoints::vertex);
}

layers::WallLayers wanted_layers(const LayerRequest& request, const SizingRequest& sizing,
                                 const LayerRule* rule) {
  layers::WallLayers wanted = layers_of_walls(request, sizing);
  if (rule != nullptr) wanted = layers_of_patch(*rule, wanted);
  const bool has_growth = request.growth || sizing.level || (rule != nullptr && rule->growth);
  if (!has_growth && wanted.first > 0 && wanted.count > 0 && wanted.total > 0)
    wanted = with_growth_of_total(wanted, request.growth_maximum);
  return at_scale(wanted, sizing.scale);
}

std::string early_end(const layers::WallLayers& asked, double edge) {
  constexpr double enough = 0.5;
  if (asked.count == 0 && asked.total <= 0) return {};
  const layers::Heights heights{asked.first, asked.growth, asked.constant};
  const std::int32_t count = layers::wanted_count(asked, edge);
  const double share = heights.last(count) / (layers::isotropic_height * edge);
  if (share >= enough) return {};
  layers::WallLayers free = asked;
  free.count = 0, free.total = 0;
  const std::string needed =
      asked.growth > 1 ? fmt::format("; {} are needed", layers::wanted_count(free, edge)) : "";
  return fmt::format("{} layers end at {:.3g}, where the last is {:.2g} % of what meets the sizes above{}",
                     count, heights.total(count), 100 * share, needed);
}

layers::WallLayers fitted_layers(const layers::WallLayers& asked, double edge, LayerFit fit,
                                 double growth_maximum) {
  if (fit == LayerFit::none || early_end(asked, edge).empty()) return asked;
  layers::WallLayers fitted = asked;
  fitted.total = 0;
  if (fit == LayerFit::count) {
    fitted.count = 0;
    return asked.growth > 1 ? fitted : asked;
  }
  if (asked.count == 0) fitted.count = layers::wanted_count(asked, edge);
  const std::int32_t steps = fitted.count - asked.constant;
  if (steps <= 0) return asked;
  const double needed = std::pow(layers::isotropic_height * edge / asked.first, 1.0 / steps);
  fitted.growth = std::clamp(needed, asked.growth, std::max(asked.growth, growth_maximum));
  return fitted;
}

std::string change_of_fit(const layers::WallLayers& asked, const layers::WallLayers& fitted, double edge) {
  if (asked.growth == fitted.growth && asked.count == fitted.count && asked.total == fitted.total) return {};
  const std::int32_t count = layers::wanted_count(fitted, edge);
  if (fitted.count == 0)
    return fmt::format("{} layers for {}, so that they end isotropic", count,
                       layers::wanted_count(asked, edge));
  std::string text = "no limit to their height";
  if (fitted.growth > asked.growth) {
    const char* const besides = asked.total > 0 ? " and no limit to their height" : "";
    text = fmt::format("growth {:.4g} for {:.4g}{}", fitted.growth, asked.growth, besides);
  }
  // Numbers of layers are rounded.
  const double last = layers::Heights{fitted.first, fitted.growth, fitted.constant}.last(count);
  if (last * fitted.growth < layers::isotropic_height * edge)
    return text + ", as much as 'layers.growth_maximum' allows";
  return text + fmt::format(", so that {} layers end isotropic", count);
}

layers::LayerOptions layer_options(const LayerRequest& request, const SizingRequest& sizing,
                                   const std::vector<std::string>& patches,
                                   const std::vector<mesh::PatchType>& types) {
  layers::LayerOptions options;
  options.patches.resize(patches.size());
  options.ends_on_planes = true;
  options.elements = request.elements;
  options.fans = request.fans;
  if (!request.given) return options;
  const layers::WallLayers wanted = wanted_layers(request, sizing);
  for (std::size_t p = 0; p < patches.size() && request.walls == LayeredWalls::all; ++p) {
    if (types.at(p) == mesh::PatchType::wall) options.patches[p] = wanted;
  }
  options.inner_sides.resize(patches.size(), layers::InnerSides::none);
  for (const LayerRule& rule : request.patches) {
    const std::size_t patch = patch_of_rule(rule, patches, types);
    options.patches[patch] = wanted_layers(request, sizing, &rule);
    options.inner_sides[patch] = rule.side;
  }
  return options;
}

LayerRequest without_missing_patches(LayerRequest request, const std::vector<std::string>& patches) {
  std::erase_if(request.patches, [&](const LayerRule& rule) {
    return std::find(patches.begin(), patches.end(), rule.name) == patches.end();
  });
  return request;
}

}  // namespace aeroloom::cases
