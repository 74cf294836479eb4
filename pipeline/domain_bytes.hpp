/// A domain as bytes: for the child that prepares it, and for checkpoints.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/repair/change.hpp"
#include "parallel/communicator.hpp"

namespace aeroloom::pipeline {

void pack_changes(const cad::Changes& changes, parallel::Packer& packer);
cad::Changes unpack_changes(parallel::Unpacker& unpacker);

void pack_domain(const cad::Domain& domain, parallel::Packer& packer);
/// Throws cad::CadError where the bytes hold no model.
cad::Domain unpack_domain(parallel::Unpacker& unpacker);

}  // namespace aeroloom::pipeline
