/// The keys of levels: sizes after the guidelines of the prediction workshops.
#pragma once

#include "pipeline/case/case_keys.hpp"

namespace aeroloom::cases {

/// Declares `level` and its companions in the section `sizing`.
void declare_levels(KeyTable& sizing, SizingRequest& request);

/// Throws CaseError for contradictions: a level with a target of elements, a letter with family dpw.
void check_levels(const KeyTable& keys, const SizingRequest& request);

/// The given far field, or the default one at the distance that the level asks for, if any.
void set_far_field(const CaseDraft& draft, cad::DomainOptions& domain);

}  // namespace aeroloom::cases
