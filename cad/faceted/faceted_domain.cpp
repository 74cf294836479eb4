#include "cad/faceted/faceted_domain.hpp"

#include "cad/domain/domain_kind.hpp"
#include "cad/domain/far_field_shape.hpp"
#include "cad/domain/patch_names.hpp"
#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/faceted_geometry.hpp"
#include "cad/faceted/half_fluid.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Patches of faces without a name go by part, then by the side of the domain they lie on.
std::vector<FaceTag> tag_facets(const FacetComplex& complex, const HullComparison* hull) {
  const Box all = box_of_points(complex.points);
  std::vector<Box> boxes(complex.faces.size());
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    for (const std::int32_t p : complex.triangles[t]) boxes[complex.face_of[t]].add(complex.points[p]);
  }
  InterfaceNames interfaces(complex.regions);
  std::vector<FaceTag> tags;
  for (std::size_t f = 0; f < complex.faces.size(); ++f) {
    const FacetComplex::Face& face = complex.faces[f];
    FaceTag tag{face.name, face.name};
    if (tag.name.empty()) tag.name = fmt::format("face_{}", f);
    tag.part = face.part, tag.layer = face.layer, tag.colour = face.colour;
    tag.number = static_cast<std::int32_t>(f);
    tag.origin = face.origin;
    if (!face.patch.empty()) tag.patch = face.patch, tag.number = face.number;
    const bool is_interface = tag.patch.empty() && face.back != no_entity;
    if (is_interface) tag.patch = interfaces(face.front, face.back);
    if (tag.patch.empty() && !hull) tag.patch = face.part;
    if (tag.patch.empty() || is_interface) tag.origin = PatchOrigin::unnamed;
    if (tag.patch.empty() && hull) tag.patch = side_of_box(boxes[f], all);
    if (tag.patch.empty() && hull && f < hull->on_hull.size() && hull->on_hull[f]) tag.patch = "outer";
    if (tag.patch.empty()) tag.patch = "body";
    tags.push_back(std::move(tag));
  }
  return tags;
}

FacetComplex with_named_regions(FacetComplex complex) {
  for (std::size_t r = 0; r < complex.regions.size(); ++r) {
    if (complex.regions[r].empty()) complex.regions[r] = fmt::format("region_{}", r);
  }
  return complex;
}

/// Tags of faces as the case wants them.
std::vector<FaceTag> facet_tags_for_case(const FacetComplex& complex, const HullComparison* hull,
                                         const DomainOptions& options, Changes& changes) {
  std::vector<FaceTag> tags = tag_facets(complex, hull);
  if (options.caps == Caps::join) join_caps(complex, tags, changes);
  return tags;
}

Model fluid_model(const FacetedGeometry& faceted, const HullComparison* hull, const DomainOptions& options,
                  Changes& changes) {
  static const HullComparison none;
  std::vector<FaceTag> tags = facet_tags_for_case(faceted.complex(), hull ? hull : &none, options, changes);
  separate_patches(tags, changes);
  return build_model({}, tags, &faceted);
}

double volume_of_regions(const Model& model) {
  double volume = 0;
  for (RegionId r = 0; r < model.region_count(); ++r) volume += model.region_volume(r);
  return volume;
}

void require_volumes(double outer, double body, double fluid) {
  const double error = std::abs(outer - body - fluid);
  if (body > 0 && error <= tolerances::sum_of_volumes * body + tolerances::rounding * outer) return;
  throw CadError(
      fmt::format("the volumes do not add up: far field {:.9g}, bodies {:.9g}, fluid {:.9g}; "
                  "the triangles are turned inside out",
                  in_file(outer, 3), in_file(body, 3), in_file(fluid, 3)));
}

/// Walls of closed halves and their far field, all of triangles.
Model surround_halves(FacetComplex walls, FacetPlane plane, const DomainOptions& all, Changes& changes) {
  FarFieldOptions options = all.far_field.value_or(all.default_far_field);
  const double unit = library_unit(largest_extent(box_of_points(walls.points).size()));
  const InLibraryUnit at_hand(unit);
  options.unit_length /= unit, plane.position /= unit;
  plane.whole = {plane.whole.low / unit, plane.whole.high / unit};
  for (Vec3& point : walls.points) point = point / unit;
  report_step("building the far field");
  const double of_walls = planar_tolerance_of(walls);
  HalfFluid fluid =
      surround_half_facets(walls, options, plane, all.feature_angle * geometry::degree, changes);
  const FacetedGeometry faceted = make_faceted_geometry(std::move(fluid.complex), of_walls);
  fluid.complex = faceted.complex();
  std::vector<FaceTag> tags = tag_facets(faceted.complex(), nullptr);
  tag_half_fluid(fluid, tags);
  if (all.caps == Caps::join) join_caps(faceted.complex(), tags, changes);
  separate_patches(tags, changes);
  const Model model = build_model({}, tags, &faceted);
  require_volumes(fluid.outer, fluid.bodies, model.region_volume(0));
  return in_file_unit(model, unit);
}

/// The fluid around bodies. The far field is made by the CAD library, in a unit of its own.
Model surround_facets(const FacetComplex& bodies, const DomainOptions& all, Changes& changes) {
  FarFieldOptions options = all.far_field.value_or(all.default_far_field);
  refuse_symmetry(options, "a faceted file");
  FacetComplex walls = outer_walls(bodies, changes);
  const double unit = library_unit(largest_extent(box_of_points(walls.points).size()));
  const InLibraryUnit at_hand(unit);
  options.unit_length /= unit;
  for (Vec3& point : walls.points) point = point / unit;
  report_step("building the far field");
  const NamedShape far_field = far_field_around(walls, options);
  const double body = -enclosed_volume(walls);
  Volumes volumes;
  const double outer = volumes.of(far_field.shape);
  const FacetedGeometry faceted = make_faceted_geometry(std::move(walls));
  std::vector<FaceTag> tags = tag_faces(far_field, DomainKind::body, nullptr);
  for (FaceTag& tag : facet_tags_for_case(faceted.complex(), nullptr, all, changes))
    tags.push_back(std::move(tag));
  separate_patches(tags, changes);
  const Model model = build_model(far_field, tags, &faceted);
  const double fluid = model.region_volume(0);
  require_volumes(outer, body, fluid);
  return in_file_unit(model, unit);
}

KindDecision choose_faceted_kind(const DomainOptions& options, const FacetComplex& complex,
                                 const std::optional<HullComparison>& hull) {
  if (options.kind != DomainKind::automatic)
    return {options.kind, options.kind == DomainKind::fluid ? "fluid, as requested" : "bodies, as requested"};
  if (options.far_field) return {DomainKind::body, "taken as a body: a far field is asked for"};
  if (complex.nested > 0) {
    return {
        DomainKind::fluid,
        fmt::format("taken as the regions to mesh: {} of its {} solids lie in others and would not meet a "
                    "fluid around them",
                    complex.nested, complex.regions.size())};
  }
  return decide_kind(*hull);
}

}  // namespace

void refuse_symmetry(const FarFieldOptions& options, const std::string& who) {
  const bool asked = options.symmetry != Symmetry::automatic && options.symmetry != Symmetry::none;
  if (!asked && options.shape != FarFieldShape::hemisphere) return;
  throw CadError(
      "a half model of " + who +
      " is not made: its triangles would have to be cut at the plane of symmetry. Remedy: "
      "farfield.symmetry: none with a sphere, box or cylinder around the whole body, or a STEP file "
      "of it");
}

NamedShape far_field_around(const FacetComplex& walls, const FarFieldOptions& options) {
  const Box box = box_of_points(walls.points);
  NamedShape named;
  named.shape = make_compound({place_far_field(options, {box, box}, std::nullopt, named.labels)});
  return named;
}

std::vector<FaceTag> tag_walls(const FacetComplex& walls, bool numbered, const DomainOptions& options,
                               Changes& changes) {
  std::vector<FaceTag> tags = facet_tags_for_case(walls, nullptr, options, changes);
  for (std::size_t f = 0; f < tags.size(); ++f) {
    if (!numbered && walls.faces[f].patch.empty()) tags[f].number = -1;
  }
  return tags;
}

Domain make_faceted_domain(const DomainOptions& options, const FacetComplex& complex, Changes changes,
                           const std::optional<FacetPlane>& plane) {
  DomainReport report;
  report.changes = std::move(changes);
  std::optional<HullComparison> hull;
  std::optional<FacetedGeometry> faceted;
  if (options.kind == DomainKind::fluid || (options.kind == DomainKind::automatic && !options.far_field)) {
    faceted = make_faceted_geometry(with_named_regions(complex));
    Changes of_trial;
    const Model alone = fluid_model(*faceted, nullptr, options, of_trial);
    hull = compare_with_hull(alone, volume_of_regions(alone), options.openings);
  }
  const KindDecision decision = choose_faceted_kind(options, complex, hull);
  report.kind = decision.kind, report.reason = decision.reason;
  const auto surround = [&] {
    return plane ? surround_halves(outer_walls(complex, report.changes), *plane, options, report.changes)
                 : surround_facets(complex, options, report.changes);
  };
  Model model = decision.kind == DomainKind::fluid ? fluid_model(*faceted, &*hull, options, report.changes)
                                                   : surround();
  if (options.trailing_edges.treatment == TrailingEdges::sharpen)
    report.changes.push_back({"no trailing edge was closed: faces of triangles are kept as they are"});
  const Vec3 size = model.body_bounds().size();
  report.reference_length = std::max({size.x, size.y, size.z});
  return {std::move(model), std::move(report)};
}

}  // namespace aeroloom::cad
