#include "pipeline/case/level_keys.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cases {

using sizing::Level;
using sizing::LevelFamily;
using sizing::SolverPoints;

void declare_levels(KeyTable& keys, SizingRequest& request) {
  std::vector<std::pair<std::string, std::optional<Level>>> levels;
  for (const Level first : {Level::a, Level::coarse}) {
    for (const Level level : sizing::levels_like(first)) levels.emplace_back(sizing::name_of(level), level);
  }
  keys.choice("level", request.level, levels,
              common({"Sizes from the guidelines of the prediction workshops "
                      "([Levels](configuration/sizing.md#levels)), finer from `A` to `F` and from `coarse` "
                      "to `extra`. Sizes that the case gives replace those of the level.",
                      "none", "B"}));
  keys.number("budget", request.budget, Range::between(100, 1e11, "tetrahedra"),
              {"Takes the finest level up to `level` whose forecast has at most this many tetrahedra. If the "
               "coarsest has more, an error states the number.",
               "none", "5e7"});
  keys.choice<std::optional<LevelFamily>>("family", request.family,
                                          {{"hlpw", std::nullopt}, {"dpw", LevelFamily::dpw}},
                                          "Whose levels `coarse` to `extra` are: `hlpw`, the high-lift "
                                          "workshop, or `dpw`, the drag workshop. Letters belong to `hlpw`.");
  keys.choice<SolverPoints>("solver", request.solver,
                            {{"vertex", SolverPoints::vertex}, {"cell", SolverPoints::cell}},
                            "Where the solver has its unknowns, to which the spacings of a level refer. With "
                            "`cell` sizes are 1.41 times as large.");
  keys.point("flow", request.flow,
             {"Direction of the flow, of any length. Leading edges lie against it, wakes along it.",
              "along x: [1, 0, 0]", "[0, 0, 1]"});
  keys.texts("lifting", request.lifting,
             {"Patterns of names of faces or patches: a level looks for trailing edges on these alone.",
              "all faces", "['wing_*', 'tail*']"});
}

void check_levels(const KeyTable& keys, const SizingRequest& request) {
  const auto refuse = [&](const std::string& key, const std::string& text) {
    throw CaseError(fmt::format("{}: {}", keys.where("sizing." + key), text));
  };
  if (request.flow && !(norm(*request.flow) > 0))
    refuse("flow", "'sizing.flow' is a direction, and must not be zero");
  if (!request.level) {
    if (request.budget) refuse("budget", "'sizing.budget' needs 'sizing.level', the finest that it may take");
    if (!request.lifting.empty()) refuse("lifting", "'sizing.lifting' needs 'sizing.level'");
    if (request.family) refuse("family", "'sizing.family: dpw' needs 'sizing.level'");
    return;
  }
  if (request.target_tetrahedra)
    refuse("target_tetrahedra",
           "'sizing.level' has all sizes, there are none left to choose for 'sizing.target_tetrahedra'");
  try {
    sizing::sizes_of(*request.level, request.family);
  } catch (const std::invalid_argument& error) {
    refuse("level", error.what());
  }
}

void set_far_field(const CaseDraft& draft, cad::DomainOptions& domain) {
  const SizingRequest& request = draft.result.sizing;
  cad::FarFieldOptions options;
  if (draft.far_field_given) options = draft.far_field;
  if (request.level && !draft.extent) {
    options.extent = sizing::sizes_of(*request.level, request.family).far_field;
    options.unit = cad::ExtentUnit::semispan;
  }
  if (draft.extent) options.extent = *draft.extent;
  if (draft.extent_unit) options.unit = *draft.extent_unit;
  if (options.unit == cad::ExtentUnit::reference) options.unit_length = request.reference_length.value_or(1);
  const geometry::Vec3 flow = request.flow.value_or(default_flow);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(flow[i]) > std::abs(flow[axis])) axis = i;
  options.flow = static_cast<cad::Axis>(axis);
  (draft.far_field_given ? domain.far_field.emplace() : domain.default_far_field) = options;
}

}  // namespace aeroloom::cases
