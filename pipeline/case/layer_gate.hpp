/// Whether the layers of a mesh are what the case asks for.
#pragma once

#include "pipeline/case/layer_rules.hpp"
#include "pipeline/case/quality_gate.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// The limits that are asked for, and what the layers have.
std::vector<GateLimit> compare_with_gate(const LayerGate& gate, const layers::LayerOptions& asked,
                                         const layers::LayerReport& report);

/// The limits that layers miss, with the patches that lack most and what keeps layers from them; empty: none.
/// `patches` are the names.
std::string missed_limits(const LayerGate& gate, const layers::LayerOptions& asked,
                          const layers::LayerReport& report, const std::vector<std::string>& patches);

}  // namespace aeroloom::cases
