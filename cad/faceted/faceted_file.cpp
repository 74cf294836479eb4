#include "cad/faceted/facet_facts.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "cad/model/step_trace.hpp"
#include "geometry/angle.hpp"

#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {

Domain prepare_faceted(const DomainOptions& options) {
  Changes changes;
  tell_step("reading the triangles");
  FacetSoup soup = read_facets(options.file);
  tell_step("repairing the triangles");
  FacetComplex complex =
      make_facet_complex(std::move(soup), options.feature_angle * geometry::degree, changes);
  tell_step("making faces of the triangles");
  return make_faceted_domain(options, std::move(complex), std::move(changes));
}

void examine_facets(const std::string& file, Diagnosis& diagnosis) {
  const FacetFacts facts = look_at_facets(read_facets(file));
  diagnosis.format = facts.format;
  diagnosis.bounds = facts.bounds;
  diagnosis.counts.shells = facts.components;
  diagnosis.counts.faces = facts.triangles;
  diagnosis.counts.open_edges = facts.open_sides;
  const auto add = [&](int count, const char* what) {
    if (count > 0) diagnosis.findings.push_back({fmt::format("{} {}", count, what)});
  };
  add(facts.without_area, "triangles without area");
  add(facts.open_sides, "sides of one triangle only: holes, or points that are not welded");
  add(facts.junction_sides, "sides of three or more triangles");
  add(facts.misoriented_sides, "sides whose triangles are turned against each other");
}

CadFacts look_at_faceted_file(const std::string& file) {
  const FacetFacts found = look_at_facets(read_facets(file));
  CadFacts facts;
  facts.format = found.format;
  facts.bounds = found.bounds;
  facts.facets = FacetCounts{
      found.points,         found.triangles,         found.components, found.without_area, found.open_sides,
      found.junction_sides, found.misoriented_sides, found.area,       found.volume};
  for (const FacetGroupFacts& group : found.groups) {
    if (!group.name.empty()) facts.face_names.push_back({group.name, group.triangles});
    if (!group.part.empty()) facts.parts.push_back({group.part, group.triangles});
  }
  return facts;
}

}  // namespace aeroloom::cad
