/// CAD read in a sandboxed run: the CAD library may throw, crash, hang or exhaust memory on a damaged file
/// without taking a rank down.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/repair/diagnosis.hpp"

#include <string>

namespace aeroloom::domain {

/// Prepares the domain in a child of this rank. Not collective. Throws what cad::prepare_domain throws;
/// cad::CadError saying what was being done when the CAD library crashed, hung or ran out of memory.
cad::Domain prepare_sandboxed(const cad::DomainOptions& options);

/// Looks at the geometry in a child of this rank; as above, but a domain that cannot be made is part of the
/// diagnosis. Not collective.
cad::Diagnosis diagnose_sandboxed(const cad::DomainOptions& options);

/// Looks at a file in a child of this rank. Not collective. Throws what cad::look_at_cad_file throws, and as
/// above.
cad::CadFacts look_sandboxed(const std::string& file);

}  // namespace aeroloom::domain
