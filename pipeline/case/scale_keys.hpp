/// The key `sizing.scale`: a family of meshes from one case.
#pragma once

#include "pipeline/case/case_keys.hpp"

namespace aeroloom::cases {

/// Declares `scale` in the section `sizing`.
void declare_scale(KeyTable& sizing, SizingRequest& request);

/// Throws CaseError where a growth to the power of the scale exceeds what its key accepts.
void check_scale(const KeyTable& keys, const CaseDraft& draft);

/// Whether the key accepts the value.
bool is_scale(double scale);

/// Why a case cannot have this scale, with a remedy; empty if it can.
std::string fault_of_scale(const SizingRequest& sizing, const LayerRequest& layers, double scale);

}  // namespace aeroloom::cases
