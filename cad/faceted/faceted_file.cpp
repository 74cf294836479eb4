#include "cad/faceted/facet_facts.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/half_facets.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/read/ignored_faces.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {

namespace {

void say_names(const FacetSoup& soup, Changes& changes) {
  for (const std::string& text : soup.read_otherwise) changes.push_back({text + encoding_hint});
}

/// Whether the case asks for half bodies in half a far field.
bool is_half(const DomainOptions& options) {
  if (!options.far_field || options.kind == DomainKind::fluid) return false;
  const Symmetry symmetry = options.far_field->symmetry;
  return options.far_field->shape == FarFieldShape::hemisphere ||
         (symmetry != Symmetry::automatic && symmetry != Symmetry::none);
}

struct PreparedTriangles {
  Domain domain;
  bool united = false, imprinted = false;
};

PreparedTriangles prepare_triangles(const DomainOptions& options, CrossingFacets crossing) {
  Changes changes;
  report_step("reading the triangles");
  FacetSoup soup = read_facets(options.file, options.encoding);
  say_names(soup, changes);
  ignore_groups(soup, options.ignore, changes);
  report_step("repairing the triangles");
  std::optional<FacetPlane> plane;
  OpeningRules openings(options.close);
  if (is_half(options)) plane = close_half_facets(soup, *options.far_field, openings, changes);
  const FacetComplex complex = make_facet_complex(std::move(soup), options.feature_angle * geometry::degree,
                                                  changes, crossing, options.voids, &openings);
  openings.require_use();
  report_step("making faces of the triangles");
  return {make_faceted_domain(options, complex, std::move(changes), plane), complex.united,
          complex.imprinted};
}

/// As regions, where solids touch at most and are the fluid; else as bodies, which are united. What crosses
/// and is taken as the fluid is for the user to unite or to part.
Domain prepare_undecided(const DomainOptions& options) {
  try {
    PreparedTriangles joined = prepare_triangles(options, CrossingFacets::join);
    if (joined.domain.report.kind == DomainKind::fluid || !joined.imprinted) return std::move(joined.domain);
  } catch (const CadError& refusal) {
    PreparedTriangles united = prepare_triangles(options, CrossingFacets::unite);
    if (united.domain.report.kind == DomainKind::fluid) throw CadError(refusal.what());
    return std::move(united.domain);
  }
  return prepare_triangles(options, CrossingFacets::unite).domain;
}

/// The triangles of outer walls as those of bodies.
FacetSoup soup_of(const FacetComplex& walls, const std::string& file) {
  FacetSoup soup;
  soup.file = file;
  soup.points = walls.points;
  soup.groups.assign(walls.faces.begin(), walls.faces.end());
  soup.group_of.assign(walls.face_of.begin(), walls.face_of.end());
  for (const auto& [a, b, c] : walls.triangles) soup.triangles.push_back({a, c, b});
  return soup;
}

}  // namespace

Domain prepare_faceted(const DomainOptions& options) {
  if (options.kind == DomainKind::automatic && !options.far_field) return prepare_undecided(options);
  return prepare_triangles(options,
                           options.kind == DomainKind::fluid ? CrossingFacets::join : CrossingFacets::unite)
      .domain;
}

FacetSoup read_bodies(const FacetedBody& body, const DomainOptions& options, Changes& changes) {
  FacetSoup soup = read_facets(body.file, options.encoding);
  say_names(soup, changes);
  if (body.name.empty()) ignore_groups(soup, options.ignore, changes);
  if (body.scale != 1) {
    for (Vec3& p : soup.points) p = body.scale * p;
    for (Vec3& p : soup.holes) p = body.scale * p;
    for (auto& region : soup.regions) region.point = body.scale * region.point;
    bound_coordinates(soup);
  }
  OpeningRules openings(body.name.empty() ? options.close : std::vector<std::string>{}, 1 / body.scale);
  const FacetComplex complex = make_facet_complex(std::move(soup), options.feature_angle * geometry::degree,
                                                  changes, CrossingFacets::unite, {}, &openings);
  openings.require_use();
  return soup_of(outer_walls(complex, changes), body.file);
}

FacetSoup read_part(const FacetedBody& part, const DomainOptions& options, Changes& changes) {
  Changes own;
  FacetSoup soup = read_bodies(part, options, own);
  for (Change& change : own) {
    change.what = fmt::format("part '{}': {}", part.name, change.what);
    changes.push_back(std::move(change));
  }
  const bool several = std::ranges::any_of(
      soup.groups, [&](const FacetSoup::Group& group) { return group.name != soup.groups.front().name; });
  for (FacetSoup::Group& group : soup.groups) {
    const bool named = several && !group.name.empty();
    group.name = named ? part.name + "_" + group.name : part.name;
    group.part = part.name, group.origin = PatchOrigin::part;
  }
  return soup;
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

CadFacts look_at_faceted_file(const std::string& file, const std::string& encoding) {
  const FacetFacts found = look_at_facets(read_facets(file, encoding));
  CadFacts facts;
  facts.format = found.format;
  facts.bounds = found.bounds;
  facts.facets = found;
  for (const FacetGroupFacts& group : found.groups) {
    if (!group.name.empty()) facts.face_names.push_back({group.name, group.triangles});
    if (!group.part.empty()) facts.parts.push_back({group.part, group.triangles});
  }
  return facts;
}

}  // namespace aeroloom::cad
