/// Loads the domain from CAD, equal on every rank. The CAD library reads in a sandbox (sandboxed_cad.hpp).
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"

#include <span>

namespace aeroloom::domain {

/// Rank 0 prepares the domain; every rank numbers its entities from the same bytes. Only rank 0 has the
/// report. Collective; throws CollectiveError.
cad::Domain load_domain(const parallel::Communicator& communicator, const cad::DomainOptions& options);

/// Sends the model of rank 0, as bytes, to every rank. Collective; throws CollectiveError.
cad::Model broadcast_model(const parallel::Communicator& communicator, parallel::Bytes bytes);

/// The domain as bytes, for a child process or a checkpoint.
parallel::Bytes pack_domain(const cad::Domain& domain);
/// Throws cad::CadError if the bytes are no model.
cad::Domain unpack_domain(std::span<const std::byte> bytes);

}  // namespace aeroloom::domain
