#include "pipeline/domain/face_patches.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/packer.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/case/box_sides.hpp"
#include "pipeline/case/openings.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

/// Before any work, and not where layers are made.
void check_layer_rules(const cases::TypedPatches& patches, const cases::Case& input) {
  const std::vector<std::string>& names = patches.model.patches();
  try {
    cases::layer_options(input.layers, input.sizing, names, patches.types);
  } catch (const std::invalid_argument& error) {
    for (const cases::LayerRule& rule : input.layers.patches) {
      if (std::ranges::find(names, rule.name) != names.end()) continue;
      throw std::invalid_argument(error.what() + cases::hint_on_box_sides(patches.model, rule.name));
    }
    throw;
  }
}

}  // namespace

cases::TypedPatches find_patches(const parallel::Communicator& communicator, const cad::Domain& domain,
                                 const cases::Case& input) {
  const cad::Model& model = domain.model;
  if (input.groups.rules.empty() && !input.groups.strict && input.patches.empty() &&
      input.layers.patches.empty()) {
    cases::TypedPatches patches = cases::apply_patch_rules(model, {});
    patches.warnings = cases::warnings_of_openings(patches, input, domain.report.kind);
    return patches;
  }
  std::string refused;
  cases::FacePatches chosen;
  parallel::Bytes bytes;
  parallel::on_root(communicator, [&] {
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::serial);
    try {
      chosen = cases::choose_patches(model, input.groups, input.patches, domain.report.removed);
      check_layer_rules(cases::apply_patches(model, chosen, input.groups, input.patches), input);
    } catch (const std::invalid_argument& error) {
      refused = error.what();  // a fault of the case, and not of the program
    }
    bytes = parallel::to_wire(std::tie(refused, chosen.patch_of_face, chosen.taken));
  });
  communicator.broadcast(bytes);
  auto all = std::tie(refused, chosen.patch_of_face, chosen.taken);
  parallel::from_wire_into(bytes, all);
  if (!refused.empty()) throw std::invalid_argument(refused);
  cases::TypedPatches patches = cases::apply_patches(model, chosen, input.groups, input.patches);
  for (std::string& warning : cases::warnings_of_openings(patches, input, domain.report.kind))
    patches.warnings.push_back(std::move(warning));
  return patches;
}

std::vector<std::string> warnings_of_lost_patches(const cases::TypedPatches& before, const cad::Model& model,
                                                  const cases::Case& input) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  std::vector<std::string> warnings;
  const auto look_at = [&](const char* section, const std::string& name) {
    if (!has(before.model.patches(), name) || has(model.patches(), name)) return;
    warnings.push_back(fmt::format(
        "{}.{}: all its faces are trailing edges that were closed, so the mesh has no patch of this name. "
        "Remedy: geometry.trailing_edges: keep, or no such patch in the case",
        section, name));
  };
  for (const cases::GroupRule& rule : input.groups.rules) look_at("groups", rule.name);
  for (const cases::PatchRule& rule : input.patches) look_at("patches", rule.name);
  for (const cases::LayerRule& rule : input.layers.patches) look_at("layers.patches", rule.name);
  return warnings;
}

}  // namespace aeroloom::domain
