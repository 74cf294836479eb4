/// Blunt trailing edges of a domain closed.
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
  std::vector<Left> left;  ///< where what is left would be no model
};

/// Closes them all or else, the longest first, as many as can be, by close_blunt_edges(). A function of the
/// model and the strips alone.
ClosedStrips close_strips(const Model& model, std::vector<BluntEdge> strips);

/// The entry in the list of changes for a strip that was closed.
Change describe_closed(const Model& model, const BluntEdge& strip);

/// The model with the strips closed that the options ask for. Every strip that was closed is appended to
/// `changes`, and so is every one that was left, with the reason. Throws CadError for a pattern that no
/// face's name matches.
Model sharpen_trailing_edges(Model model, const TrailingEdgeOptions& options, Changes& changes);

}  // namespace aeroloom::cad
