#include "pipeline/case/openings.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::cases {
namespace {

using mesh::PatchType;

/// The expression for a name that has these letters, in either case, and others than letters between them.
std::string pattern_of(std::string_view letters) {
  constexpr const char* other = "[^A-Za-z]*";
  std::string pattern = fmt::format("re:^{}", other);
  for (const char c : letters)
    pattern += fmt::format("[{}{}]{}", c, char(std::toupper(static_cast<unsigned char>(c))), other);
  return pattern + "$";
}

/// Whether names alone select the group: where other conditions hold too, a name may be that of many faces.
bool goes_by_name(const GroupRule& rule) {
  FaceConditions others = rule.all;
  others.faces.clear();
  return others.empty() && rule.any.empty() && rule.except.empty();
}

std::vector<std::string> opening_patterns(PatchType type, const FaceGroups& groups,
                                          const std::vector<PatchRule>& rules) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& own, const std::vector<std::string>& faces) {
    if (faces.empty()) return names.push_back(own);
    names.insert(names.end(), faces.begin(), faces.end());
  };
  for (const GroupRule& rule : groups.rules)
    if (rule.type == type && goes_by_name(rule)) add(rule.name, rule.all.faces);
  for (const PatchRule& rule : rules)
    if (rule.type == type) add(rule.name, rule.faces);
  for (const std::string_view letters : mesh::usual_names_of(type)) names.push_back(pattern_of(letters));
  return names;
}

std::optional<std::string> first_of(PatchType type, const TypedPatches& patches) {
  const auto found = std::ranges::find(patches.types, type);
  if (found == patches.types.end()) return std::nullopt;
  return patches.model.patches()[found - patches.types.begin()];
}

}  // namespace

cad::OpeningNames opening_names(const FaceGroups& groups, const std::vector<PatchRule>& rules) {
  return {opening_patterns(PatchType::inlet, groups, rules),
          opening_patterns(PatchType::outlet, groups, rules)};
}

std::vector<std::string> warnings_of_openings(const TypedPatches& patches, const Case& input,
                                              cad::DomainKind decided) {
  const cad::DomainOptions& asked = input.domain;
  const bool undecided =
      asked.kind == cad::DomainKind::automatic && !asked.far_field && !asked.transport && asked.parts.empty();
  if (!undecided || decided != cad::DomainKind::body) return {};
  const std::optional<std::string> inlet = first_of(PatchType::inlet, patches);
  const std::optional<std::string> outlet = first_of(PatchType::outlet, patches);
  if (!inlet || !outlet) return {};
  return {
      fmt::format("'{}' and '{}' are inlet and outlet of a body in a far field, as those of an engine. "
                  "`geometry.domain: fluid` takes the solids for the space to mesh, as in a duct; `body` "
                  "says that they are none",
                  *inlet, *outlet)};
}

}  // namespace aeroloom::cases
