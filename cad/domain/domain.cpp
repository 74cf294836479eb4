#include "cad/domain/domain.hpp"

#include "cad/domain/baffles.hpp"
#include "cad/domain/domain_kind.hpp"
#include "cad/domain/far_field.hpp"
#include "cad/domain/far_field_shape.hpp"
#include "cad/domain/mixed_bodies.hpp"
#include "cad/domain/patch_names.hpp"
#include "cad/domain/removed_names.hpp"
#include "cad/domain/trailing_edges.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/read/cad_reader.hpp"
#include "cad/read/export.hpp"
#include "cad/read/ignored_faces.hpp"
#include "cad/repair/crossing_borders.hpp"
#include "cad/repair/crossing_faces.hpp"
#include "cad/repair/heal.hpp"
#include "cad/repair/noise.hpp"
#include "cad/repair/shells.hpp"
#include "cad/tolerances.hpp"
#include "geometry/long_names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

constexpr const char* left_out = "the CAD library leaves out geometry of the file";

NamedShape read_source(const DomainOptions& options, Changes& changes) {
  NamedShape source =
      options.transport ? make_transport(*options.transport) : read_cad_file(options.file, options.encoding);
  if (!source.refused.empty()) changes.push_back({left_out + source.refused, {}, 0, true});
  for (const std::string& text : source.read_otherwise) changes.push_back({text + encoding_hint});
  ignore_faces(source, options.ignore, changes);
  return source;
}

/// Faces have the names that they have in a fluid, as cases know openings.
HullComparison compare(const NamedShape& solids, const OpeningNames& openings, Volumes& volumes) {
  const Model model = build_model(solids, tag_faces(solids, DomainKind::fluid, nullptr));
  refuse_border_crossings(model);
  return compare_with_hull(model, volumes.of(solids.shape), openings);
}

/// `hull` receives the comparison where one was made.
KindDecision choose_kind(const DomainOptions& options, const NamedShape& solids, Volumes& volumes,
                         std::optional<HullComparison>& hull) {
  if (options.kind != DomainKind::automatic)
    return {options.kind, options.kind == DomainKind::fluid ? "fluid, as requested" : "bodies, as requested"};
  if (options.transport) return {DomainKind::body, "the built-in aircraft is a body"};
  if (options.far_field) return {DomainKind::body, "taken as a body: a far field is asked for"};
  if (!options.parts.empty()) return {DomainKind::body, "taken as bodies: there are parts"};
  const std::vector<TopoDS_Solid> all = solids_of(solids.shape);
  if (const int nested = all.size() > 1 ? count_in_cavities(all, volumes) : 0) {
    return {
        DomainKind::fluid,
        fmt::format("taken as the regions to mesh: {} of its {} solids lie in cavities of others and would "
                    "not meet a fluid around them",
                    nested, all.size())};
  }
  const auto inside = std::ranges::count(solids.loose, true, &LooseFace::in_solid);
  if (inside > 0) {
    return {DomainKind::fluid,
            fmt::format("taken as the fluid: {} face(s) of its solids lie inside of them, as baffles do",
                        inside)};
  }
  hull = compare(solids, options.openings, volumes);
  return decide_kind(*hull, count_loose_inside(solids));
}

/// The solids that are meshed, the far field included.
struct FluidShape {
  NamedShape shape;
  KindDecision decision;
  std::optional<HullComparison> hull;   ///< of the shape, where it was made
  bool triangulated = false;            ///< its faces, coarsely
  bool united = false;                  ///< several bodies by the CAD library
  std::optional<MixedFluid> mixed;      ///< with bodies of triangles; `shape` is not used then
  std::vector<std::string> names = {};  ///< in the file
};

/// Of a file of triangles, which has parts. `none` has no shape, but a unit.
FluidShape make_fluid_around_facets(NamedShape none, const DomainOptions& options, Volumes& volumes,
                                    Changes& changes) {
  FluidShape fluid;
  fluid.decision = {DomainKind::body, "taken as bodies: there are parts"};
  fluid.mixed = surround_mixed(std::move(none), {}, options, volumes, changes);
  return fluid;
}

/// Bodies in a far field. With a reason to `distrust` unions of the CAD library, none is made.
FluidShape surround_bodies(NamedShape solids, const DomainOptions& options, const std::string& distrust,
                           Volumes& volumes, Changes& changes) {
  const std::size_t before = solids_of(solids.shape).size();
  std::vector<RefusedUnion> refused;
  solids = distrust.empty() ? unite_bodies(std::move(solids), volumes, changes, refused)
                            : refuse_unions(std::move(solids), distrust, refused);
  std::size_t after = solids_of(solids.shape).size();
  if (before > 1 && after > 0) solids = close_noise(std::move(solids), options.smallest_size, changes);
  for (const RefusedUnion& each : refused) after += each.solids.size();
  FluidShape fluid;
  fluid.united = after < before;
  if (refused.empty() && options.parts.empty())
    fluid.shape =
        surround(std::move(solids), options.far_field.value_or(options.default_far_field), volumes, changes);
  else
    fluid.mixed = surround_mixed(std::move(solids), refused, options, volumes, changes);
  return fluid;
}

/// The options with lengths in the unit of the shapes. Those of trailing edges stay: the model is scaled
/// then.
DomainOptions in_unit(DomainOptions options, double unit) {
  const auto convert = [&](FarFieldOptions& far_field) {
    far_field.unit_length /= unit;
    if (far_field.symmetry_position) *far_field.symmetry_position /= unit;
  };
  convert(options.default_far_field);
  if (options.far_field) convert(*options.far_field);
  options.smallest_size /= unit;
  for (FacetedBody& part : options.parts) part.scale /= unit;
  return options;
}

bool has_facets(const DomainOptions& options) {
  return !options.transport && is_faceted_file(options.file);
}

/// The unit alone of a file of triangles.
NamedShape read_shape(const DomainOptions& options, Changes& changes) {
  if (!has_facets(options)) return read_source(options, changes);
  NamedShape none;
  none.unit = library_unit(largest_extent(box_of_points(read_facets(options.file).points).size()));
  return none;
}

/// The plane of symmetry that closes open halves, if the case asks for one.
std::optional<HalfPlane> half_plane_of(const DomainOptions& options) {
  if (!options.far_field || options.kind == DomainKind::fluid) return std::nullopt;
  const FarFieldOptions& far_field = *options.far_field;
  switch (far_field.symmetry) {
    case Symmetry::x:
      return HalfPlane{0, far_field.symmetry_position};
    case Symmetry::y:
      return HalfPlane{1, far_field.symmetry_position};
    case Symmetry::z:
      return HalfPlane{2, far_field.symmetry_position};
    case Symmetry::automatic:
      if (far_field.shape == FarFieldShape::hemisphere) return HalfPlane{std::nullopt};
      break;
    case Symmetry::none:
      break;
  }
  return std::nullopt;
}

/// make_solids(); what is open may be so because something was left out.
NamedShape make_solids_of_source(NamedShape source, const DomainOptions& options, Volumes& volumes,
                                 Changes& changes) {
  const std::string refused = source.refused;
  OpeningRules openings(options.close, source.unit);
  std::optional<HalfPlane> half = half_plane_of(options);
  if (half) half->openings = &openings;
  try {
    NamedShape solids =
        make_solids(std::move(source), options.smallest_size, volumes, changes, half, &openings);
    openings.require_use();
    return solids;
  } catch (const CadError& error) {
    if (refused.empty()) throw;
    throw CadError(fmt::format("{} ({}{})", error.what(), left_out, refused));
  }
}

FluidShape make_fluid(NamedShape source, const DomainOptions& options, const std::string& distrust,
                      Volumes& volumes, Changes& changes) {
  if (has_facets(options)) return make_fluid_around_facets(std::move(source), options, volumes, changes);
  if (source.cut_names > 0) changes.push_back({geometry::long_names_text(source.cut_names), {}, 0, true});
  std::vector<std::string> names = names_of_file(source);
  NamedShape solids = make_solids_of_source(std::move(source), options, volumes, changes);
  std::optional<HullComparison> hull;
  KindDecision decision = choose_kind(options, solids, volumes, hull);
  const bool triangulated = hull.has_value();
  const bool single = solids_of(solids.shape).size() == 1;
  if (decision.kind == DomainKind::body) {
    drop_loose(solids, changes);
    DomainOptions at_plane = options;
    if (solids.symmetry_position && at_plane.far_field) {
      constexpr std::array planes{Symmetry::x, Symmetry::y, Symmetry::z};
      at_plane.far_field->symmetry = planes[solids.symmetry_axis];
      at_plane.far_field->symmetry_position = solids.symmetry_position;
    }
    FluidShape fluid = surround_bodies(std::move(solids), at_plane, distrust, volumes, changes);
    fluid.decision = std::move(decision), fluid.hull = hull;
    fluid.triangulated = triangulated && !fluid.mixed;
    fluid.names = std::move(names);
    return fluid;
  }
  solids = join_regions(std::move(solids), volumes, changes);
  if (!single) {
    solids = close_noise(std::move(solids), options.smallest_size, changes);
    hull.reset();  // joined ones have other faces
  }
  const bool has_baffles = place_baffles(solids, options.baffles, volumes, changes);
  if (has_baffles) hull.reset();
  return {std::move(solids), std::move(decision), hull, triangulated && !has_baffles, false, {},
          std::move(names)};
}

/// Tags of the faces as the case wants them.
std::vector<FaceTag> tags_for_case(const NamedShape& shape, DomainKind kind, const HullComparison* hull,
                                   const DomainOptions& options, Changes& changes) {
  std::vector<FaceTag> tags = tag_faces(shape, kind, hull);
  if (options.caps == Caps::join) join_caps(shape, tags, changes);
  return tags;
}

Model build_mixed(const MixedFluid& fluid, const DomainOptions& options, Volumes& volumes, Changes& changes) {
  std::vector<FaceTag> tags = tags_for_case(fluid.shape, DomainKind::body, nullptr, options, changes);
  tags.insert(tags.end(), fluid.wall_tags.begin(), fluid.wall_tags.end());
  separate_patches(tags, changes);
  Model model = build_model(fluid.shape, tags, fluid.walls ? &*fluid.walls : nullptr);
  require_mixed_volume(model, fluid, volumes);
  return model;
}

Model build_domain(const FluidShape& fluid, const DomainOptions& options, Volumes& volumes,
                   Changes& changes) {
  if (fluid.mixed) return build_mixed(*fluid.mixed, options, volumes, changes);
  std::optional<HullComparison> hull = fluid.hull;
  const bool is_fluid = fluid.decision.kind == DomainKind::fluid;
  if (is_fluid && !hull) hull = compare(fluid.shape, {}, volumes);
  std::vector<FaceTag> tags = tags_for_case(fluid.shape, is_fluid ? DomainKind::fluid : DomainKind::body,
                                            is_fluid ? &*hull : nullptr, options, changes);
  separate_patches(tags, changes);
  return build_model(fluid.shape, tags);
}

/// The CAD library knows points to one length whatever the unit; far from the origin numbers are further
/// apart.
void require_representable(const Box& box) {
  double farthest = 0;
  for (const Vec3& corner : {box.low, box.high})
    farthest = std::max({farthest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
  const double spacing = std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest;
  if (spacing <= tolerances::bearable_spacings * tolerances::library_length) return;
  throw CadError(
      fmt::format("the domain reaches out to {:.3g} in the file's unit, where numbers of the computer are "
                  "{:.2g} apart, but "
                  "the CAD library tells points {:.0g} apart. Remedy: a larger unit, a model near the "
                  "origin, or a far field "
                  "that is nearer (FarFieldOptions::extent)",
                  in_file(farthest), in_file(spacing), in_file(tolerances::library_length)));
}

/// Triangulates every face coarsely, where nobody did: what the CAD library cannot triangulate is found here,
/// where a crash is sandboxed.
void try_facets(const Model& model) {
  constexpr double deflection = 0.01,
                   angle = 0.6;  // of the diagonal; radians: coarser than what any stage asks for
  for (FaceId f = 0; f < model.face_count(); ++f)
    model.facets(f, deflection * model.bounds().diagonal(), angle);
}

NamedShape make_geometry(const DomainOptions& options, Volumes& volumes, Changes& changes) {
  NamedShape source = read_source(options, changes);
  const InLibraryUnit at_hand(source.unit);
  const double smallest_size = options.smallest_size / source.unit;
  return make_solids(std::move(source), smallest_size, volumes, changes);
}

Domain prepare(const DomainOptions& options, const std::string& distrust = {});

/// With bodies united as triangles, where the CAD library cannot triangulate what it united.
Domain prepare_anew(const DomainOptions& options, const std::string& fault) {
  try {
    return prepare(options, fault);
  } catch (const CadError& error) {
    throw CadError(fmt::format("{}; nor can the bodies be united as triangles: {}", fault, error.what()));
  }
}

Domain prepare(const DomainOptions& options, const std::string& distrust) {
  DomainReport report;
  Volumes volumes;
  NamedShape source = read_shape(options, report.changes);
  const double unit = source.unit;
  const auto [fluid, shapes] = [&] {
    const InLibraryUnit at_hand(unit);
    FluidShape made =
        make_fluid(std::move(source), in_unit(options, unit), distrust, volumes, report.changes);
    Model within = build_domain(made, options, volumes, report.changes);
    require_representable(within.bounds());
    if (!made.triangulated) refuse_border_crossings(within);
    return std::pair(std::move(made), std::move(within));
  }();
  report.kind = fluid.decision.kind;
  report.reason = fluid.decision.reason;
  for (Change& change : report.changes) change = in_file_unit(std::move(change), unit);
  Model model = sharpen_trailing_edges(in_file_unit(shapes, unit), options.trailing_edges, report.changes);
  try {
    if (!fluid.triangulated) try_facets(model);
    refuse_face_crossings(model);
  } catch (const CadError& error) {
    if (fluid.united && distrust.empty()) return prepare_anew(options, error.what());
    throw;
  }
  report.reference_length = largest_extent(model.body_bounds().size());
  report.removed = find_removed_names(fluid.names, model, report.changes);
  return {std::move(model), std::move(report)};
}

/// Errors below know the entity, not the file.
template <class Action>
auto with_source(const DomainOptions& options, Action&& action) {
  const std::string source = options.transport ? "the built-in aircraft" : fmt::format("'{}'", options.file);
  try {
    return guarded("preparing the domain", std::forward<Action>(action));
  } catch (const CadError& error) {
    const std::string text = error.what();
    const auto is_named = [&](const std::string& name) { return text.find(name) != std::string::npos; };
    if (is_named(source)) throw;
    for (const FacetedBody& part : options.parts)
      if (is_named(part.file)) throw;
    throw CadError(source + ": " + text);
  }
}

}  // namespace

Domain prepare_domain(const DomainOptions& options) {
  return with_source(options, [&] {
    if (has_facets(options) && options.parts.empty()) return prepare_faceted(options);
    if (!options.voids.empty()) {
      throw CadError(
          "DomainOptions::voids names solids of a file of triangles without parts beside it; in CAD, "
          "cut the void out of the solid");
    }
    return prepare(options);
  });
}

void export_step(const DomainOptions& options, ExportedShape shape, const std::string& file) {
  with_source(options, [&] {
    const auto refuse_facets = [] {
      throw CadError("triangles are not written as STEP. Remedy: geometry of a CAD program");
    };
    if (has_facets(options) || !options.parts.empty()) refuse_facets();
    Changes changes;
    Volumes volumes;
    if (shape == ExportedShape::geometry) return write_step(make_geometry(options, volumes, changes), file);
    NamedShape source = read_source(options, changes);
    const InLibraryUnit at_hand(source.unit);
    const DomainOptions within = in_unit(options, source.unit);
    const FluidShape fluid = make_fluid(std::move(source), within, {}, volumes, changes);
    if (fluid.mixed) refuse_facets();
    write_step(fluid.shape, file);
  });
}

}  // namespace aeroloom::cad
