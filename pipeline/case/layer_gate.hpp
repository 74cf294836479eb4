/// Compares the layers of a mesh with the limits of the case.
#pragma once

#include "pipeline/case/layer_rules.hpp"
#include "pipeline/case/quality_gate.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

/// Each limit that is set, with the value of the mesh.
std::vector<GateLimit> compare_with_gate(const LayerGate& gate, const layers::LayerOptions& asked,
                                         const layers::LayerReport& report);

/// A message about missed limits: the patches that miss most, and what limits their layers. Empty if none is
/// missed. `patches`: names by patch.
std::string missed_limits(const LayerGate& gate, const layers::LayerOptions& asked,
                          const layers::LayerReport& report, const std::vector<std::string>& patches);

/// A warning about walls that ask for layers and have none at all, with what prevents most. Empty if each has
/// some.
std::string missing_layers(const layers::LayerOptions& asked, const layers::LayerReport& report,
                           const std::vector<std::string>& patches);

}  // namespace aeroloom::cases
