/// The keys of boundary layers: the section `layers`.
#pragma once

#include "pipeline/case/case_keys.hpp"

namespace aeroloom::cases {

/// Declares the section; rules of patches that are read are added to those of the draft.
void declare_layers(KeyTable& root, CaseDraft& draft);

/// Throws CaseError where there is no height of the first layer, or are two, and for keys that come in pairs.
void check_layers(const KeyTable& keys, const CaseDraft& draft);

}  // namespace aeroloom::cases
