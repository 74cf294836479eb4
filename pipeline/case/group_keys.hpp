/// The keys below `groups`.
#pragma once

#include "pipeline/case/face_groups.hpp"
#include "pipeline/case/patch_rules.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Declares `groups`; rules that are read are added to `rules`, which must outlive the table as `strict`
/// must.
void declare_groups(KeyTable& root, std::deque<GroupRule>& rules, bool& strict);

/// Throws CaseError where a rule has texts that stand for nothing, or shares its name with a patch.
void check_groups(const KeyTable& keys, const std::deque<GroupRule>& rules,
                  const std::deque<PatchRule>& patches);

/// Throws CaseError for a pattern of faces' names with an expression that is none; `path` is its key.
void check_patterns(const KeyTable& keys, const std::string& path, const std::vector<std::string>& patterns);

/// Declares the choice of a boundary condition for patches and groups.
void declare_patch_type(KeyTable& keys, std::optional<mesh::PatchType>& type);

}  // namespace aeroloom::cases
