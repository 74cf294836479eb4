/// Reads CAD in a child process. The CAD library may throw, crash, hang or exhaust memory there; the rank
/// lives on.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/repair/diagnosis.hpp"

#include <string>

namespace aeroloom::domain {

/// Prepares the domain in a child of this rank. Not collective. Throws as cad::prepare_domain(), and
/// cad::CadError with the current step if the library crashed, hung or ran out of memory.
cad::Domain prepare_sandboxed(const cad::DomainOptions& options);

/// Diagnoses the geometry in a child of this rank. A domain that cannot be made is part of the diagnosis. Not
/// collective. Throws as prepare_sandboxed() otherwise.
cad::Diagnosis diagnose_sandboxed(const cad::DomainOptions& options);

/// Inspects a file in a child of this rank. Not collective. Throws as cad::look_at_cad_file() and
/// prepare_sandboxed().
cad::CadFacts look_sandboxed(const std::string& file, const std::string& encoding);

}  // namespace aeroloom::domain
