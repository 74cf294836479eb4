#include "pipeline/case/case.hpp"

#include "geometry/name_text.hpp"
#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/given_lengths.hpp"
#include "pipeline/case/group_keys.hpp"
#include "pipeline/case/layer_keys.hpp"
#include "pipeline/case/level_keys.hpp"
#include "pipeline/case/openings.hpp"
#include "pipeline/case/scale_keys.hpp"
#include "pipeline/case/source_keys.hpp"
#include "pipeline/case/wall_keys.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

void check_parts(const KeyTable& keys, const CaseDraft& draft) {
  for (const cad::FacetedBody& part : draft.parts) {
    const std::string key = "geometry.parts." + part.name;
    if (part.file.empty()) throw CaseError(keys.where(key) + ": '" + key + "' needs 'file', its triangles");
    if (draft.result.domain.kind == cad::DomainKind::fluid)
      throw CaseError(keys.where(key) + ": '" + key +
                      "' is a body in a far field, but 'geometry.domain' is fluid");
  }
}

void check_geometry(const KeyTable& keys, const CaseDraft& draft, const std::string& file) {
  const auto at = [&](const std::string& key) { return keys.where("geometry." + key) + ": "; };
  const bool from_file = !draft.result.domain.file.empty(), built_in = draft.builtin != Builtin::none;
  if (!from_file && !built_in) {
    throw CaseError(file + ": the case has no geometry; give 'geometry.file' or 'geometry.builtin'");
  }
  if (from_file && built_in) {
    throw CaseError(at("builtin") + "'geometry.file' and 'geometry.builtin' exclude each other");
  }
  if (draft.dimensions_given && !built_in) {
    throw CaseError(at("dimensions") + "'geometry.dimensions' belongs to 'geometry.builtin', not to a file");
  }
  check_parts(keys, draft);
  try {
    geometry::require_encoding(draft.result.domain.encoding);
  } catch (const std::invalid_argument& error) {
    throw CaseError(at("encoding") + "'geometry.encoding': " + error.what());
  }
  const cad::TrailingEdgeOptions& trailing = draft.result.domain.trailing_edges;
  const char* const needless = draft.sharpen_width       ? "sharpen_width"
                               : !trailing.faces.empty() ? "sharpen_faces"
                                                         : nullptr;
  if (needless != nullptr && trailing.treatment != cad::TrailingEdges::sharpen) {
    throw CaseError(at(needless) +
                    fmt::format("'geometry.{}' needs 'geometry.trailing_edges: sharpen'", needless));
  }
  if (draft.extent_unit == cad::ExtentUnit::reference && !draft.result.sizing.reference_length) {
    throw CaseError(keys.where("farfield.unit") +
                    ": 'farfield.unit: reference_length' needs 'sizing.reference_length', such as a chord");
  }
  if (draft.result.domain.kind != cad::DomainKind::fluid) return;
  if (built_in)
    throw CaseError(at("domain") + "the built-in geometry is a body, 'geometry.domain' cannot be fluid");
  if (draft.far_field_given) {
    throw CaseError(keys.where("farfield") + ": 'farfield' surrounds bodies, but 'geometry.domain' is fluid");
  }
}

/// Refuses `smaller` above `larger`, wherever the two were given.
void check_order(const KeyTable& keys, const std::string& smaller, std::optional<double> small_value,
                 const std::string& larger, std::optional<double> large_value) {
  if (!small_value || !large_value || *small_value <= *large_value) return;
  throw CaseError(fmt::format("{}: '{}' is {}, but must be at least '{}', which is {} ({})",
                              keys.where(larger), larger, *large_value, smaller, *small_value,
                              keys.where(smaller)));
}

void check_sizing(const KeyTable& keys, const SizingRequest& sizing) {
  check_order(keys, "sizing.minimum", sizing.minimum, "sizing.maximum", sizing.maximum);
  check_order(keys, "sizing.minimum", sizing.minimum, "sizing.surface_maximum", sizing.surface_maximum);
}

/// Where the geometry of a case file is: seen from its folder or else from the working directory.
std::string locate(const std::string& geometry_file, const std::string& case_file) {
  namespace fs = std::filesystem;
  if (geometry_file.empty() || fs::path(geometry_file).is_absolute()) return geometry_file;
  const fs::path beside_case = fs::path(case_file).parent_path() / geometry_file;
  std::error_code ignored;  // what cannot be looked at is not there
  return fs::exists(beside_case, ignored) ? beside_case.string() : geometry_file;
}

/// What was read, once it fits together.
Case finish(const KeyTable& keys, const CaseDraft& draft, const std::string& name) {
  check_geometry(keys, draft, name);
  check_sizing(keys, draft.result.sizing);
  check_expression(keys, draft.result.sizing.expression);
  check_levels(keys, draft.result.sizing);
  check_layers(keys, draft);
  check_scale(keys, draft);
  check_sources(keys, draft.sources);
  check_groups(keys, draft.groups, draft.patches);
  for (const PatchRule& rule : draft.patches)
    check_patterns(keys, "patches." + rule.name + ".faces", rule.faces);
  check_patterns(keys, "geometry.voids", draft.result.domain.voids);
  check_patterns(keys, "geometry.sharpen_faces", draft.result.domain.trailing_edges.faces);
  check_patterns(keys, "geometry.ignore", draft.result.domain.ignore);
  for (const SourceDraft& source : draft.sources) {
    for (const auto& [key, patterns] : source.patterns)
      check_patterns(keys, "sizing.sources." + source.name + "." + key, patterns);
  }
  for (const WallRule& rule : draft.walls)
    check_patterns(keys, "sizing.walls." + rule.name + ".faces", rule.faces);
  for (const EdgeRule& rule : draft.edges)
    check_patterns(keys, "sizing.edges." + rule.name + ".between", rule.between);
  check_patterns(keys, "sizing.lifting", draft.result.sizing.lifting);
  check_walls(keys, draft.walls);
  check_edges(keys, draft.edges);
  Case result = draft.result;
  result.domain.parts.assign(draft.parts.begin(), draft.parts.end());
  result.groups.rules.assign(draft.groups.begin(), draft.groups.end());
  result.groups.where = keys.where("groups.strict");
  for (GroupRule& rule : result.groups.rules) {
    rule.where = keys.where("groups." + rule.name);
    if (rule.size) result.sizing.patch_sizes.push_back({rule.name, *rule.size});
    if (rule.type) result.sizing.patch_types.emplace_back(rule.name, *rule.type);
  }
  result.patches.assign(draft.patches.begin(), draft.patches.end());
  result.sizing.sources = rules_of(draft.sources);
  result.sizing.walls.assign(draft.walls.begin(), draft.walls.end());
  result.sizing.edges.assign(draft.edges.begin(), draft.edges.end());
  result.layers.given = result.layers.first || result.layers.reynolds || !draft.layer_rules.empty();
  result.layers.patches.assign(draft.layer_rules.begin(), draft.layer_rules.end());
  for (LayerRule& rule : result.layers.patches) rule.where = keys.where("layers.patches." + rule.name);
  for (PatchRule& rule : result.patches) {
    rule.where = keys.where("patches." + rule.name);
    if (rule.size) result.sizing.patch_sizes.push_back({rule.name, *rule.size});
    if (rule.type) result.sizing.patch_types.emplace_back(rule.name, *rule.type);
  }
  result.domain.openings = opening_names(result.groups, result.patches);
  if (draft.builtin == Builtin::transport) result.domain.transport = draft.dimensions;
  set_far_field(draft, result.domain);
  result.domain.trailing_edges.width = draft.sharpen_width.value_or(0);
  result.lengths = given_lengths(keys, result.sizing.reference_length.value_or(1));
  result.domain.smallest_size = in_model_units(result.sizing).minimum.value_or(0);
  return result;
}

}  // namespace

Case read_case(const std::string& file, const std::vector<std::string>& overrides) {
  CaseDraft draft;
  KeyTable keys;
  declare_case_keys(keys, draft);
  keys.read_file(file);
  for (const std::string& assignment : overrides) keys.read_override(assignment);
  Case result = finish(keys, draft, file);
  const auto is_overridden = [&](const std::string& key) {
    return std::any_of(overrides.begin(), overrides.end(), [&](const std::string& assignment) {
      const std::string path = assignment.substr(0, assignment.find('='));
      return key == path || key.starts_with(path + ".");
    });
  };
  if (!is_overridden("geometry.file")) result.domain.file = locate(result.domain.file, file);
  for (cad::FacetedBody& part : result.domain.parts)
    if (!is_overridden("geometry.parts." + part.name + ".file")) part.file = locate(part.file, file);
  return result;
}

Case case_of_resolved(const std::string& yaml) {
  CaseDraft draft;
  KeyTable keys;
  declare_case_keys(keys, draft);
  keys.read_text(yaml, "the resolved case");
  return finish(keys, draft, "the resolved case");
}

Case case_of_overrides(const std::vector<std::string>& overrides) {
  CaseDraft draft;
  KeyTable keys;
  declare_case_keys(keys, draft);
  for (const std::string& assignment : overrides) keys.read_override(assignment);
  return draft.result;
}

std::string resolved_yaml(const Case& input) {
  CaseDraft draft;
  draft.result = input;
  if (input.domain.transport) {
    draft.builtin = Builtin::transport;
    draft.dimensions = *input.domain.transport;
    draft.dimensions_given = true;
  }
  if (input.domain.trailing_edges.width > 0) draft.sharpen_width = input.domain.trailing_edges.width;
  if (input.domain.far_field) {
    draft.far_field = *input.domain.far_field;
    draft.extent = draft.far_field.extent, draft.extent_unit = draft.far_field.unit;
    draft.far_field_given = true;
  }
  draft.parts.assign(input.domain.parts.begin(), input.domain.parts.end());
  draft.groups.assign(input.groups.rules.begin(), input.groups.rules.end());
  draft.patches.assign(input.patches.begin(), input.patches.end());
  draft.sources = drafts_of(input.sizing.sources);
  draft.walls.assign(input.sizing.walls.begin(), input.sizing.walls.end());
  draft.edges.assign(input.sizing.edges.begin(), input.sizing.edges.end());
  draft.layer_rules.assign(input.layers.patches.begin(), input.layers.patches.end());
  KeyTable keys;
  declare_case_keys(keys, draft);
  for (const cad::FacetedBody& part : input.domain.parts) keys.add_named("geometry.parts", part.name);
  for (const GroupRule& rule : input.groups.rules) keys.add_named("groups", rule.name);
  for (const PatchRule& rule : input.patches) keys.add_named("patches", rule.name);
  for (const SourceRule& rule : input.sizing.sources) keys.add_named("sizing.sources", rule.name);
  for (const WallRule& rule : input.sizing.walls) keys.add_named("sizing.walls", rule.name);
  for (const EdgeRule& rule : input.sizing.edges) keys.add_named("sizing.edges", rule.name);
  for (const LayerRule& rule : input.layers.patches) keys.add_named("layers.patches", rule.name);
  return keys.write();
}

}  // namespace aeroloom::cases
