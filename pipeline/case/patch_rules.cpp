#include "pipeline/case/patch_rules.hpp"

#include "cad/model/patches.hpp"
#include "pipeline/case/box_sides.hpp"
#include "pipeline/case/nearest_name.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

using mesh::PatchType;

/// The type that a group or a rule of `patches` gives to a patch.
struct PatchSetting {
  std::string key, name;
  std::optional<PatchType> type;
};

std::vector<PatchSetting> patch_settings(const FaceGroups& groups, const std::vector<PatchRule>& rules) {
  std::vector<PatchSetting> all;
  for (const GroupRule& rule : groups.rules) all.push_back({"groups." + rule.name, rule.name, rule.type});
  for (const PatchRule& rule : rules) all.push_back({"patches." + rule.name, rule.name, rule.type});
  return all;
}

bool is_like(const cad::Model& model, cad::FaceId face, const cad::NamePattern& pattern) {
  const cad::Face& f = model.face(face);
  return pattern.matches(f.name) || pattern.matches(model.patches()[f.patch]);
}

/// Names of patches first, then those of faces, each once.
std::vector<std::string> names_of(const cad::Model& model) {
  std::vector<std::string> names = model.patches();
  std::set<std::string> known(names.begin(), names.end());
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (known.insert(model.face(f).name).second) names.push_back(model.face(f).name);
  }
  return names;
}

/// The key, after its place in the case.
std::string origin_of(const PatchRule& rule) {
  return fmt::format("{}patches.{}", rule.where.empty() ? "" : rule.where + ": ", rule.name);
}

constexpr const char* may_be_empty = "`optional: true` where the rule may match nothing";

/// A name of the file that no face has any more is no mistake in the case.
void refuse_removed(const PatchRule& rule, const std::string& pattern,
                    const std::vector<cad::RemovedName>& removed) {
  const cad::NamePattern wanted(pattern);
  const auto found =
      std::ranges::find_if(removed, [&](const cad::RemovedName& each) { return wanted.matches(each.name); });
  if (found == removed.end()) return;
  throw std::invalid_argument(fmt::format("{}: the file has '{}', but the domain has not: {}. Remedy: {}",
                                          origin_of(rule), found->name, found->reason, may_be_empty));
}

[[noreturn]] void refuse_pattern(const cad::Model& model, const PatchRule& rule, const std::string& pattern) {
  constexpr std::size_t most = 5;
  std::vector<std::string> names = names_of(model);
  const auto distance = [&](const std::string& name) { return edit_distance(pattern, name); };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); });
  std::string nearest;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    nearest += fmt::format("{}'{}'", i > 0 ? ", " : "", names[i]);
  throw std::invalid_argument(
      fmt::format("{}: no face and no patch of this model is like '{}'; the nearest names are {}{}. Remedy: "
                  "`aeroloom check` lists the patches; * stands for any characters, ? for one; {}",
                  origin_of(rule), pattern, nearest, hint_on_box_sides(model, pattern), may_be_empty));
}

/// The faces that a rule takes from those that are still free.
void take_faces(const cad::Model& model, const PatchRule& rule, const std::vector<cad::RemovedName>& removed,
                FacePatches& chosen) {
  const std::vector<std::string> own{rule.name};
  bool takes_any = false, matches_any = false;
  for (const std::string& text : rule.faces.empty() ? own : rule.faces) {
    const cad::NamePattern pattern(text);
    bool any = false;
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      if (!is_like(model, f, pattern)) continue;
      any = matches_any = true;
      if (chosen.taken[f]) continue;
      takes_any = true;
      chosen.taken[f] = 1;
      chosen.patch_of_face[f] = rule.name;
    }
    if (any || rule.optional) continue;
    refuse_removed(rule, text, removed);
    refuse_pattern(model, rule, text);
  }
  if (!takes_any && matches_any && !rule.optional) {
    throw std::invalid_argument(
        fmt::format("{}: all faces that it matches belong to groups, or to patches before it. "
                    "Remedy: put it first",
                    origin_of(rule)));
  }
}

/// Where groups are strict, every face of the boundary that the program did not add is in one, or in a patch
/// of the case.
void require_all_taken(const cad::Model& model, const FaceGroups& groups, const FacePatches& chosen) {
  if (!groups.strict) return;
  constexpr std::size_t most = 10;
  std::string names;
  std::size_t left = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (chosen.taken[f] || model.is_far_field(f) || model.face(f).back != cad::no_entity) continue;
    const geometry::Vec3 at = model.face_place(f).centre;
    if (left++ < most)
      names += fmt::format("{}'{}' (around {:.6g}, {:.6g}, {:.6g})", left > 1 ? ", " : "", model.face(f).name,
                           at.x, at.y, at.z);
  }
  if (left == 0) return;
  throw std::invalid_argument(
      fmt::format("{}'groups.strict': {} of {} faces are in no group and in no patch of the case: {}{}. "
                  "Remedy: a group for "
                  "them (`rest: {{faces: '*'}}` at the end takes all), or `strict: false`",
                  groups.where.empty() ? "" : groups.where + ": ", left, model.face_count(), names,
                  left > most ? fmt::format(", and {} more", left - most) : ""));
}

PatchType default_type(const cad::Model& model, std::int32_t patch) {
  bool far = true, inner = true;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.face(f).patch != patch) continue;
    far = far && model.is_far_field(f);
    inner = inner && model.face(f).back != cad::no_entity;
  }
  if (inner) return PatchType::interior;
  // The plane of symmetry that the program cuts belongs to the far field, too.
  return mesh::patch_type_by_name(model.patches()[patch])
      .value_or(far ? PatchType::farfield : PatchType::wall);
}

/// Says of a rule what it does not get, and what it gets besides.
void warn(TypedPatches& patches, const PatchSetting& rule, const std::vector<char>& taken) {
  const cad::Model& model = patches.model;
  int inner = 0, left = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.patches()[model.face(f).patch] != rule.name) continue;
    inner += model.face(f).back != cad::no_entity ? 1 : 0;
    left += taken[f] ? 0 : 1;
  }
  if (inner > 0 && rule.type && *rule.type != PatchType::interior)
    patches.warnings.push_back(
        fmt::format("{}: {} of its faces have a fluid on both sides and no condition: the type "
                    "'{}' is not theirs",
                    rule.key, inner, mesh::name_of(*rule.type)));
  if (left > 0)
    patches.warnings.push_back(
        fmt::format("{}: the model has a patch of this name, and its faces that no rule takes ({}) "
                    "stay in it, too. "
                    "Remedy: another name",
                    rule.key, left));
}

}  // namespace

FacePatches choose_patches(const cad::Model& model, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules,
                           const std::vector<cad::RemovedName>& removed) {
  FacePatches chosen;
  const std::vector<std::int32_t> group_of_face = find_groups(model, groups.rules);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const std::int32_t group = group_of_face[f];
    chosen.taken.push_back(group != no_group ? 1 : 0);
    chosen.patch_of_face.push_back(group != no_group ? groups.rules[group].name
                                                     : model.patches()[model.face(f).patch]);
  }
  for (const PatchRule& rule : rules) take_faces(model, rule, removed, chosen);
  require_all_taken(model, groups, chosen);
  return chosen;
}

TypedPatches apply_patches(const cad::Model& model, const FacePatches& chosen, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules) {
  const std::vector<PatchSetting> settings = patch_settings(groups, rules);
  TypedPatches result{settings.empty() ? model : cad::with_patches(model, chosen.patch_of_face), {}, {}};
  const std::vector<std::string>& patches = result.model.patches();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    PatchType type = default_type(result.model, static_cast<std::int32_t>(p));
    for (const PatchSetting& rule : settings) {
      if (rule.name == patches[p] && rule.type && type != PatchType::interior) type = *rule.type;
    }
    result.types.push_back(type);
  }
  for (const PatchSetting& rule : settings) warn(result, rule, chosen.taken);
  return result;
}

TypedPatches apply_patch_rules(const cad::Model& model, const std::vector<PatchRule>& rules,
                               const FaceGroups& groups) {
  return apply_patches(model, choose_patches(model, groups, rules), groups, rules);
}

}  // namespace aeroloom::cases
