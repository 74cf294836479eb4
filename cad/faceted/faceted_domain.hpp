/// Domains of faceted files. Seen by cad/ only.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/model/model_data.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/repair/diagnosis.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// As prepare_domain, of a faceted file. Throws CadError also where a plane of symmetry is asked for.
Domain prepare_faceted(const DomainOptions& options);
/// The same from the triangles on.
Domain make_faceted_domain(const DomainOptions& options, const FacetComplex& complex, Changes changes);

/// The outer triangles of the bodies in a file, closed and repaired, times `scale`; those that cross are
/// united.
FacetSoup read_bodies(const std::string& file, double scale, double feature_angle, Changes& changes);

/// The triangles of a part, in the model's unit, closed and repaired; its faces belong to the part and are
/// called as it is, with the name of their group where there are several. Throws as prepare_faceted.
FacetSoup read_part(const FacetedBody& part, double feature_angle, Changes& changes);

/// What encloses bodies of triangles alone: the far field's shape, with its labels.
NamedShape far_field_around(const FacetComplex& walls, const FarFieldOptions& options);
/// Throws CadError where a half model is asked for; `who` cannot be cut.
void refuse_symmetry(const FarFieldOptions& options, const std::string& who);
/// Names and patches of the faces of walls, in their order. Numbers are left out unless `numbered`.
std::vector<FaceTag> tag_walls(const FacetComplex& walls, bool numbered);

/// The counts, bounds and findings of a faceted file as it is read.
void examine_facets(const std::string& file, Diagnosis& diagnosis);
CadFacts look_at_faceted_file(const std::string& file);

}  // namespace aeroloom::cad
