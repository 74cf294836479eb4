/// Keys of levels: sizes as guidelines of the prediction workshops have them.
#pragma once

#include "pipeline/case/case_keys.hpp"

namespace aeroloom::cases {

/// Declares `level` and what goes with it, in the section of sizes.
void declare_levels(KeyTable& sizing, SizingRequest& request);

/// Throws CaseError where keys are at odds: a level and a target of elements, a letter and the family dpw.
void check_levels(const KeyTable& keys, const SizingRequest& request);

/// The far field as it was given, or else the default one: as far away as the level asks for, if any.
void set_far_field(const CaseDraft& draft, cad::DomainOptions& domain);

}  // namespace aeroloom::cases
