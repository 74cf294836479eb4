/// A domain as bytes: for the child that prepares it, and for checkpoints.
#pragma once

#include "cad/domain/domain.hpp"
#include "parallel/communication/packer.hpp"

#include <span>

namespace aeroloom::domain {

parallel::Bytes pack_domain(const cad::Domain& domain);
/// Throws cad::CadError where the bytes hold no model.
cad::Domain unpack_domain(std::span<const std::byte> bytes);

}  // namespace aeroloom::domain
