/// The domain from CAD, the same on every rank. What reads CAD runs in a sandbox (sandboxed_cad.hpp).
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"

namespace aeroloom::domain {

/// Rank 0 prepares the domain; every rank numbers its entities from the same bytes. Only rank 0 has the
/// report. Collective; throws CollectiveError.
cad::Domain load_domain(const parallel::Communicator& communicator, const cad::DomainOptions& options);

/// The model that rank 0 has as bytes, on every rank. Collective; throws CollectiveError.
cad::Model broadcast_model(const parallel::Communicator& communicator, parallel::Bytes bytes);

}  // namespace aeroloom::domain
