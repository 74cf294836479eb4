/// Assigns the faces of a domain to the patches of the case.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

#include <string>
#include <vector>

namespace aeroloom::domain {

/// The model with the patches of the case's groups and rules. Only rank 0 computes areas, boxes and normals
/// and decides; the others get the result, and need no report. Collective. Throws std::invalid_argument on
/// every rank as cases::choose_patches() and cases::layer_options().
cases::TypedPatches find_patches(const parallel::Communicator& communicator, const cad::Domain& domain,
                                 const cases::Case& input);

/// Names that the case speaks of and that are patches before sizing, but not in the sized `model`: all their
/// faces were closed. One warning for each. Not collective.
std::vector<std::string> warnings_of_lost_patches(const cases::TypedPatches& before, const cad::Model& model,
                                                  const cases::Case& input);

}  // namespace aeroloom::domain
