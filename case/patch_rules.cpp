#include "aeroloom/case/patch_rules.hpp"

#include "cad/model/patches.hpp"
#include "case/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

using mesh::PatchType;

bool is_like(const cad::Model& model, cad::FaceId face, const std::string& pattern) {
  const cad::Face& f = model.face(face);
  return cad::matches_pattern(f.name, pattern) || cad::matches_pattern(model.patches()[f.patch], pattern);
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

[[noreturn]] void refuse_pattern(const cad::Model& model, const PatchRule& rule, const std::string& pattern) {
  constexpr std::size_t most = 5;
  std::vector<std::string> names = names_of(model);
  const auto distance = [&](const std::string& name) { return edit_distance(pattern, name); };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); });
  std::string nearest;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    nearest += fmt::format("{}'{}'", i > 0 ? ", " : "", names[i]);
  throw std::invalid_argument(fmt::format(
      "patches.{}: no face and no patch of this model is like '{}'; the nearest names are {}. Remedy: "
      "`aeroloom check` lists the patches; * stands for any characters, ? for one",
      rule.name, pattern, nearest));
}

/// The faces that a rule takes from those that are still free.
void take_faces(const cad::Model& model, const PatchRule& rule, std::vector<std::string>& patch_of_face,
                std::vector<char>& taken) {
  const std::vector<std::string> own{rule.name};
  bool takes_any = false;
  for (const std::string& pattern : rule.faces.empty() ? own : rule.faces) {
    bool any = false;
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      if (!is_like(model, f, pattern)) continue;
      any = true;
      if (taken[f]) continue;
      takes_any = true;
      taken[f] = 1;
      patch_of_face[f] = rule.name;
    }
    if (!any) refuse_pattern(model, rule, pattern);
  }
  if (!takes_any) {
    throw std::invalid_argument(
        fmt::format("patches.{}: all faces that it matches belong to patches before it. Remedy: put it first",
                    rule.name));
  }
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
void warn(TypedPatches& patches, const PatchRule& rule, const std::vector<char>& taken) {
  const cad::Model& model = patches.model;
  int inner = 0, left = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.patches()[model.face(f).patch] != rule.name) continue;
    inner += model.face(f).back != cad::no_entity ? 1 : 0;
    left += taken[f] ? 0 : 1;
  }
  if (inner > 0 && rule.type && *rule.type != PatchType::interior)
    patches.warnings.push_back(
        fmt::format("patches.{}: {} of its faces lie between two regions and have no condition: the type "
                    "'{}' is not theirs",
                    rule.name, inner, mesh::name_of(*rule.type)));
  if (left > 0)
    patches.warnings.push_back(
        fmt::format("patches.{}: the model has a patch of this name, and its faces that no rule takes ({}) "
                    "stay in it, too. "
                    "Remedy: another name",
                    rule.name, left));
}

}  // namespace

TypedPatches apply_patch_rules(const cad::Model& model, const std::vector<PatchRule>& rules) {
  std::vector<std::string> patch_of_face(model.face_count());
  std::vector<char> taken(model.face_count(), 0);
  for (cad::FaceId f = 0; f < model.face_count(); ++f)
    patch_of_face[f] = model.patches()[model.face(f).patch];
  for (const PatchRule& rule : rules) take_faces(model, rule, patch_of_face, taken);
  TypedPatches result{rules.empty() ? model : cad::with_patches(model, patch_of_face), {}, {}};
  const std::vector<std::string>& patches = result.model.patches();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    PatchType type = default_type(result.model, static_cast<std::int32_t>(p));
    for (const PatchRule& rule : rules) {
      if (rule.name == patches[p] && rule.type && type != PatchType::interior) type = *rule.type;
    }
    result.types.push_back(type);
  }
  for (const PatchRule& rule : rules) warn(result, rule, taken);
  return result;
}

}  // namespace aeroloom::cases
