#include "geometry/domain.hpp"

#include "geometry/cad_reader.hpp"
#include "geometry/domain_kind.hpp"
#include "geometry/export.hpp"
#include "geometry/far_field.hpp"
#include "geometry/heal.hpp"
#include "geometry/occ_guard.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::geometry {
namespace {

NamedShape read_source(const DomainOptions& options) {
  if (options.transport) return make_transport(*options.transport);
  return read_cad_file(options.file);
}

HullComparison compare(const NamedShape& solids) {
  return compare_with_hull(build_model(solids, tag_faces(solids, DomainKind::body, nullptr)),
                           volume_of(solids.shape));
}

/// `hull` receives the comparison where one was made.
KindDecision choose_kind(const DomainOptions& options, const NamedShape& solids,
                         std::optional<HullComparison>& hull) {
  if (options.kind != DomainKind::automatic) return {options.kind, "as requested"};
  if (options.transport) return {DomainKind::body, "the built-in aircraft is a body"};
  if (options.far_field) return {DomainKind::body, "taken as a body: a far field is asked for"};
  hull = compare(solids);
  return decide_kind(*hull);
}

/// `hull` compares the solids as they are; joined ones have other faces.
Model build_fluid(NamedShape solids, std::optional<HullComparison> hull, std::vector<std::string>& changes) {
  const bool single = solids_of(solids.shape).size() == 1;
  const NamedShape fluid = join_regions(std::move(solids), changes);
  if (!hull || !single) hull = compare(fluid);
  return build_model(fluid, tag_faces(fluid, DomainKind::fluid, &*hull));
}

Model build_around_bodies(NamedShape solids, const FarFieldOptions& far_field,
                          std::vector<std::string>& changes) {
  const NamedShape fluid = surround(unite_bodies(std::move(solids), changes), far_field, changes);
  return build_model(fluid, tag_faces(fluid, DomainKind::body, nullptr));
}

double largest_extent(Vec3 size) {
  return std::max({size.x, size.y, size.z});
}

Domain prepare(const DomainOptions& options) {
  DomainReport report;
  NamedShape solids = make_solids(read_source(options), report.changes);
  std::optional<HullComparison> hull;
  const KindDecision decision = choose_kind(options, solids, hull);
  report.kind = decision.kind;
  report.reason = decision.reason;
  Model model = report.kind == DomainKind::fluid
                    ? build_fluid(std::move(solids), hull, report.changes)
                    : build_around_bodies(std::move(solids), options.far_field.value_or(FarFieldOptions{}),
                                          report.changes);
  report.reference_length = largest_extent(model.body_bounds().size());
  return {std::move(model), std::move(report)};
}

std::string source_name(const DomainOptions& options) {
  return options.transport ? "the built-in aircraft" : fmt::format("'{}'", options.file);
}

/// Errors below know the entity, not the file.
template <class Action>
auto with_source(const DomainOptions& options, Action&& action) {
  const std::string source = source_name(options);
  try {
    return guarded("preparing the domain", std::forward<Action>(action));
  } catch (const CadError& error) {
    const std::string text = error.what();
    if (text.find(source) != std::string::npos) throw;
    throw CadError(source + ": " + text);
  }
}

}  // namespace

Domain prepare_domain(const DomainOptions& options) {
  return with_source(options, [&] { return prepare(options); });
}

void export_step(const DomainOptions& options, const std::string& file) {
  with_source(options, [&] {
    std::vector<std::string> changes;
    write_step(make_solids(read_source(options), changes), file);
  });
}

}  // namespace aeroloom::geometry
