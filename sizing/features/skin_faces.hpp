/// The faces of the skin of a lifting body.
#pragma once

#include "cad/model/model.hpp"

#include <set>
#include <span>

namespace aeroloom::sizing {

/// The kinks across which a skin continues: all up to 50 degrees, or only those that are no valley of more
/// than 15. Beyond such a valley another body begins, for example the fuselage below a wing.
enum class Kinks : bool { all, no_valleys };

/// The faces `first` and those that continue them, at most 64. Far field faces and `except` are left out.
std::set<cad::FaceId> skin_faces(const cad::Model& model, std::span<const cad::FaceId> first,
                                 cad::FaceId except, Kinks kinks);

}  // namespace aeroloom::sizing
