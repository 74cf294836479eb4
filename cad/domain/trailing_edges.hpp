/// Closes blunt trailing edges of a domain.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/topology/blunt_edges.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

struct ClosedStrips {
  struct Left {
    BluntEdge strip;
    std::string reason;
  };
  Model model;
  std::vector<BluntEdge> closed;
  std::vector<Left> left;  ///< strips that cannot be closed
};

/// Closes all strips. If that fails, closes as many as possible, the longest first. The result depends on the
/// model and the strips alone.
ClosedStrips close_strips(const Model& model, std::vector<BluntEdge> strips);

/// The entry in the list of changes for a closed strip.
Change describe_closed(const Model& model, const BluntEdge& strip);

/// The model with those strips closed that the options ask for. Every closed strip is appended to `changes`,
/// and every other one with the reason. Throws CadError if a pattern matches no name.
Model sharpen_trailing_edges(Model model, const TrailingEdgeOptions& options, Changes& changes);

}  // namespace aeroloom::cad
