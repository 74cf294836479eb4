/// Assigns the faces of a domain to the patches of the case.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

namespace aeroloom::domain {

/// The model with the patches of the case's groups and rules. Only rank 0 computes areas, boxes and normals
/// and decides; the others get the result. Collective. Throws std::invalid_argument on every rank as
/// cases::choose_patches().
cases::TypedPatches find_patches(const parallel::Communicator& communicator, const cad::Model& model,
                                 const cases::Case& input);

}  // namespace aeroloom::domain
