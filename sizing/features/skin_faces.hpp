/// The faces of a lifting body's skin.
#pragma once

#include "cad/model/model.hpp"

#include <set>
#include <span>

namespace aeroloom::sizing {

/// Kinks over which a skin goes on: all up to 50 degrees, or none that is a valley of more than 15: there
/// another body begins (a fuselage below a wing).
enum class Kinks : bool { all, no_valleys };

/// Those of `first` and what goes on from them, no far field, without `strip`; 64 at most.
std::set<cad::FaceId> skin_faces(const cad::Model& model, std::span<const cad::FaceId> first,
                                 cad::FaceId strip, Kinks kinks);

}  // namespace aeroloom::sizing
