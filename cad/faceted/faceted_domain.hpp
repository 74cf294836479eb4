/// Domains of faceted files. Seen by cad/ only.
#pragma once

#include "aeroloom/cad/domain/domain.hpp"
#include "aeroloom/cad/read/cad_facts.hpp"
#include "aeroloom/cad/repair/diagnosis.hpp"
#include "cad/faceted/facet_complex.hpp"

namespace aeroloom::cad {

/// As prepare_domain, of a faceted file. Throws CadError also where a plane of symmetry is asked for.
Domain prepare_faceted(const DomainOptions& options);
/// The same from the triangles on.
Domain make_faceted_domain(const DomainOptions& options, FacetComplex complex, Changes changes);

/// The counts, bounds and findings of a faceted file as it is read.
void examine_facets(const std::string& file, Diagnosis& diagnosis);
CadFacts look_at_faceted_file(const std::string& file);

}  // namespace aeroloom::cad
