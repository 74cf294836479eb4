/// Makes domains from faceted files. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_plane.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/model/model_data.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/repair/diagnosis.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// As prepare_domain, for a faceted file.
Domain prepare_faceted(const DomainOptions& options);
/// The same, from the repaired triangles on, which are halves closed by `plane` if there is one.
Domain make_faceted_domain(const DomainOptions& options, const FacetComplex& complex, Changes changes,
                           const std::optional<FacetPlane>& plane = {});

/// Reads and repairs the triangles of a file, scales them, and keeps the outer walls of the bodies. Bodies
/// that cross are united. A body without a name is the file of the case, some of whose groups may be ignored.
FacetSoup read_bodies(const FacetedBody& body, const DomainOptions& options, Changes& changes);

/// As read_bodies, for a part of the case. Faces get the name of the part, with that of their group if there
/// are several groups. Throws as prepare_faceted.
FacetSoup read_part(const FacetedBody& part, const DomainOptions& options, Changes& changes);

/// The far field around bodies of triangles alone, with its labels.
NamedShape far_field_around(const FacetComplex& walls, const FarFieldOptions& options);
/// Throws CadError if the options ask for a half model. `who` says what cannot be cut.
void refuse_symmetry(const FarFieldOptions& options, const std::string& who);
/// Names and patches of wall faces, in their order. Faces get numbers only if `numbered`.
std::vector<FaceTag> tag_walls(const FacetComplex& walls, bool numbered, const DomainOptions& options,
                               Changes& changes);

/// Fills in counts, bounds and defects of a faceted file as it is.
void examine_facets(const std::string& file, Diagnosis& diagnosis);
CadFacts look_at_faceted_file(const std::string& file, const std::string& encoding);

}  // namespace aeroloom::cad
