/// Refuses lengths that are none of the model, before any work with them.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

namespace aeroloom::domain {

/// Throws std::invalid_argument on every rank, with file, line, value and range, where a length of the case
/// is far smaller or larger than the body (cases::fault_of_lengths()). Rank 0 has the places in the file.
/// Collective.
void require_lengths_of_model(const parallel::Communicator& communicator, const cad::Model& model,
                              const cases::Case& input);

}  // namespace aeroloom::domain
