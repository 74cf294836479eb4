/// Blunt trailing edges of a domain closed on request. Seen by this folder only.
#pragma once

#include "cad/domain/domain.hpp"

namespace aeroloom::cad {

/// The model with the strips closed that the options ask for. Every strip that was closed is appended to
/// `changes`, and so is every one that was left, with the reason. Throws CadError for a pattern that no
/// face's name matches.
Model sharpen_trailing_edges(Model model, const TrailingEdgeOptions& options, Changes& changes);

}  // namespace aeroloom::cad
