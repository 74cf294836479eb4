/// Inlets and outlets of a case: what they tell of its solids.
#pragma once

#include "pipeline/case/case.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// Patterns for the names of inlets and outlets: of patches of these types, of groups that names alone
/// select, and the usual names.
cad::OpeningNames opening_names(const FaceGroups& groups, const std::vector<PatchRule>& rules);

/// A warning where `auto` has taken solids with an inlet and an outlet for a body; else nothing.
std::vector<std::string> warnings_of_openings(const TypedPatches& patches, const Case& input,
                                              cad::DomainKind decided);

}  // namespace aeroloom::cases
