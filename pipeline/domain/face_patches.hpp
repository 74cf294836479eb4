/// The patches that a case makes of the faces of its domain.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

namespace aeroloom::domain {

/// The model with the patches of the case's groups and rules. Rank 0 alone looks at areas, boxes and normals
/// and decides, so that all ranks have the same and a message has the place in the case file. Collective.
/// Throws std::invalid_argument on every rank as cases::choose_patches().
cases::TypedPatches find_patches(const parallel::Communicator& communicator, const cad::Model& model,
                                 const cases::Case& input);

}  // namespace aeroloom::domain
