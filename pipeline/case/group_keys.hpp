/// The keys of the section `groups`.
#pragma once

#include "pipeline/case/face_groups.hpp"
#include "pipeline/case/patch_rules.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Declares `groups`. Rules that are read are appended to `rules`; `rules` and `strict` must outlive the
/// table.
void declare_groups(KeyTable& root, std::deque<GroupRule>& rules, bool& strict);

/// Throws CaseError for invalid texts in a rule, and for a group named as a patch of the case.
void check_groups(const KeyTable& keys, const std::deque<GroupRule>& rules,
                  const std::deque<PatchRule>& patches);

/// Throws CaseError for an invalid name pattern; `path` is its key.
void check_patterns(const KeyTable& keys, const std::string& path, const std::vector<std::string>& patterns);

/// Declares the key for the boundary condition of a patch or group.
void declare_patch_type(KeyTable& keys, std::optional<mesh::PatchType>& type);

}  // namespace aeroloom::cases
