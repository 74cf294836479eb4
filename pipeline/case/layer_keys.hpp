/// The keys of the section `layers` (boundary layers).
#pragma once

#include "pipeline/case/case_keys.hpp"

namespace aeroloom::cases {

/// Declares the section. Rules of patches that are read are appended to the draft.
void declare_layers(KeyTable& root, CaseDraft& draft);

/// Throws CaseError if the first height is missing or given twice, and for incomplete pairs of keys.
void check_layers(const KeyTable& keys, const CaseDraft& draft);

}  // namespace aeroloom::cases
