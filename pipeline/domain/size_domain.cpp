#include "pipeline/domain/size_domain.hpp"

#include "cad/model/patches.hpp"
#include "cad/model/topology/joined_faces.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/domain/level_sizes.hpp"
#include "sizing/choice/choose_sizes.hpp"
#include "sizing/choice/coincident_faces.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/features/narrow_faces.hpp"
#include "sizing/lifting/trailing_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

/// Of the smallest size: how far the mesh may leave the surface where a narrow face vanishes. A twentieth of
/// an element is less than what the element itself leaves of a curved surface. Chosen, not measured.
constexpr double join_tolerance = 0.05;
/// Tetrahedra predicted over those aimed at, or the other way round, from which on a warning says so: more
/// than searches end with (sizing/choice/choose_sizes.cpp) and forecasts err by.
constexpr double missed_target = 1.35;
/// Logarithm of what a key does to the count, from which on it is named: about the logarithm of
/// missed_target.
constexpr double least_named_cost = 0.2;
/// Tetrahedra that are to be made over those asked for, or the other way round, from which on sizes are
/// chosen once more.
constexpr double most_missed = 1.2;
/// The same where features that were to make it more are among them.
constexpr double most_with_features = 1.3;
/// A surface is always asked what it will hold where the target is at most this: forecasts of few elements
/// err more. Asking takes what the decomposition does, some 0.4 s of 6 at 500,000. Chosen, not measured.
constexpr double few_elements = 600'000;
/// Of the target: elements in gaps that are named.
constexpr double named_gaps = 0.25;

/// The model without faces narrower than `width`, where neighbours can take them in.
std::optional<cad::Model> join_narrow_faces(const parallel::Communicator& communicator,
                                            const cad::Model& model, double width, JoinedFaces& what) {
  const double tolerance = join_tolerance * width;
  std::vector<sizing::NarrowFace> narrow = sizing::find_narrow_faces(communicator, model, width, tolerance);
  if (narrow.empty()) return std::nullopt;
  std::optional<cad::Model> joined;
  parallel::collectively(communicator, parallel::ScopedCpu::As::repeated, [&] {
    what.groups = sizing::group_narrow_faces(model, narrow, tolerance);
    joined = cad::join_faces(model, what.groups);
  });
  for (const sizing::NarrowFace& each : narrow) {
    what.changes.push_back(
        {fmt::format("face '{}' is {:.3g} wide, less than the smallest size, and was joined with "
                     "'{}', from which it turns by {:.2g} degrees",
                     model.face(each.face).name, each.width, model.face(each.into).name, each.degrees),
         each.place, each.deviation});
  }
  return joined;
}

/// The number of tetrahedra that sizes are chosen for; none where all sizes are given.
std::optional<double> target_of(const cases::SizingRequest& request) {
  if (request.target_tetrahedra) return request.target_tetrahedra;
  return request.minimum && request.maximum ? std::nullopt : std::optional(cases::default_target);
}

std::string text_of_cost(const sizing::BoundCost& cost) {
  const std::string what = cost.bound == sizing::of_features
                               ? "features finer than sizing.minimum (bounded by sizing.feature_minimum)"
                               : "sizing." + cost.bound;
  const char* verb = cost.bound == sizing::of_features ? "make" : "makes";
  return std::isinf(cost.ratio) ? fmt::format("{} {} it far too many", what, verb)
                                : fmt::format("{} {} it {:.2g} times as many", what, verb, cost.ratio);
}

/// Which given keys leave no room, where none does so alone.
std::string describe_all(const std::vector<sizing::BoundCost>& costs) {
  std::string names;
  for (const sizing::BoundCost& cost : costs) {
    if (cost.bound == sizing::of_features) continue;
    names += (names.empty() ? "sizing." : ", sizing.") + cost.bound;
  }
  return names.empty() ? "" : "what is given leaves no other choice (" + names + ")";
}

/// The effect of each given key on the count, the largest first.
std::string describe_costs(std::vector<sizing::BoundCost> costs) {
  const auto weight = [](const sizing::BoundCost& cost) { return std::abs(std::log(cost.ratio)); };
  std::stable_sort(costs.begin(), costs.end(),
                   [&](const auto& a, const auto& b) { return weight(a) > weight(b); });
  constexpr std::size_t shown = 2;  // a warning is one sentence
  std::size_t named = 0;
  std::string text;
  for (const sizing::BoundCost& cost : costs) {
    if (weight(cost) < least_named_cost || named++ == shown) break;
    text += (text.empty() ? "" : ", ") + text_of_cost(cost);
  }
  return text.empty() ? describe_all(costs) : text;
}

/// Says what sources add to the target.
void tell_of_sources(const sizing::FieldFactory& factory, const sizing::ChosenSizes& chosen) {
  if (!factory.sampled().communicator().is_root() || !(chosen.aimed > 0)) return;
  parallel::log_info(fmt::format(
      "sizing: sizing.sources come on top of the target: about {:.2g} tetrahedra, {:.2g} without them",
      chosen.counts.tetrahedra, chosen.aimed));
}

/// A sentence where no sizes come near what was aimed at, with the keys that forbid it.
std::string describe_missed_target(sizing::FieldFactory& factory, const sizing::ChosenSizes& chosen,
                                   const cases::SizingRequest& request, double target) {
  const double ratio = chosen.counted() / target;
  if (ratio < std::max(missed_target, 1.1 * request.feature_budget) && ratio > 1 / missed_target) return {};
  const std::string costs = describe_costs(sizing::costs_of_given(factory, chosen, request));
  const bool has_far_field = cad::is_around_bodies(factory.model());
  const std::string remedy =
      ratio > 1 ? fmt::format("{}a larger sizing.growth or larger sizes make it fewer",
                              has_far_field ? "a far field that is nearer (farfield.extent), " : "")
                : "smaller sizes (sizing.surface_maximum, sizing.maximum) make it more";
  const double gaps = chosen.counted() * (chosen.features.gap_ratio - 1) / chosen.features.ratio;
  std::string why;
  if (gaps > named_gaps * target)
    why = fmt::format(
        ", some {:.2g} of them for one element across gaps between walls{}", gaps,
        chosen.features.gaps_limited ? fmt::format(" wider than {:.3g}", chosen.features.gap_floor) : "");
  if (!costs.empty()) why += "; " + costs;
  if (ratio > 1)
    why +=
        fmt::format("; the least target that this case meets is about {:.2g}", sizing::least_target(chosen));
  return fmt::format("sizing.target_tetrahedra is {:.3g}, but about {:.2g} tetrahedra are predicted{}: {}",
                     target, chosen.counted(), why, remedy);
}

/// The purpose of a choice of sizes, and the sizes that it starts from.
struct Aim {
  sizing::FieldFor purpose;
  /// Sizes for a model that is almost the same, where they are known and the target is to be met.
  std::optional<sizing::SizingOptions> near;
  Experience seen = {};
};

/// Sizes before any are chosen: those given, or what coarse fields promise of them.
struct Trial {
  sizing::SizingOptions sizes;                          ///< where nothing is left to choose
  std::optional<sizing::PreliminarySizes> preliminary;  ///< else
};

/// The sizes that trailing edges are judged by. Its functions refer to the factory.
TrialSizes trial_sizes(sizing::FieldFactory& factory, const sizing::SizingOptions& options) {
  return {[=](double width) { return sizing::narrow_size(width, options) / width; }, options.minimum,
          [&factory, options](const std::vector<geometry::Vec3>& places) {
            return factory.sizes_without_features(places, options);
          }};
}

Trial try_sizes(sizing::FieldFactory& factory, const cases::SizingRequest& request,
                const std::optional<sizing::SizingOptions>& near, const Experience& seen) {
  const std::optional<double> target = target_of(request);
  if (!target) return {sizing::with_given({}, request), {}};
  const double by_fields = *target / seen.bias;
  const double aimed = std::max(by_fields, seen.at_places + sizing::least_share * by_fields);
  return {{}, sizing::preliminary_sizes(factory, aimed, request.feature_budget, near, request)};
}

sizing::SizingOptions sizes_of_edges(sizing::FieldFactory& factory, const cases::SizingRequest& request,
                                     const Trial& trial) {
  if (!trial.preliminary) return trial.sizes;
  return sizing::sizes_for_edges(factory, *target_of(request), request.feature_budget, *trial.preliminary,
                                 request);
}

/// The sized domain of the factory's model, which stays as it is.
SizedDomain finish(sizing::FieldFactory& factory, const cases::SizingRequest& request, const Trial& trial,
                   JoinedFaces joined, const Aim& aim) {
  if (!trial.preliminary) {
    sizing::ChosenSizes applied = sizing::apply_sizes(factory, trial.sizes, aim.purpose);
    SizingFindings findings{std::move(joined), applied.counts};
    findings.bounded = report_bounded_faces(factory, trial.sizes);
    findings.far_field = factory.sampled().far_field_decision();
    return {factory.model(), trial.sizes, std::move(applied.field), std::move(findings)};
  }
  const double target = *target_of(request);
  sizing::ChosenSizes chosen = sizing::choose_sizes(factory, *trial.preliminary, request, aim.purpose);
  for (double* count : {&chosen.counts.tetrahedra, &chosen.aimed}) *count *= aim.seen.bias;
  tell_of_sources(factory, chosen);
  SizingFindings findings{std::move(joined), chosen.counts};
  findings.missed_target = describe_missed_target(factory, chosen, request, target);
  if (!request.holds_features())
    findings.features = report_features(factory.sampled(), chosen.features, chosen.counted());
  findings.bounded = report_bounded_faces(factory, chosen.options);
  findings.far_field = factory.sampled().far_field_decision();
  SizedDomain sized{factory.model(), chosen.options, std::move(chosen.field), std::move(findings)};
  sized.on_top = chosen.counts.tetrahedra - chosen.counted();
  sized.seen = aim.seen;
  return sized;
}

sizing::SizeRequests requests_of(const cases::SizingRequest& request) {
  sizing::SizeRequests requests{{}, request.patch_sizes};
  for (const cases::SourceRule& rule : request.sources) {
    const auto add = [&](const auto& shape) {
      if constexpr (std::is_convertible_v<decltype(shape), sizing::SolidShape>)
        requests.regions.push_back({rule.name, shape, rule.size});
      else
        requests.wakes.push_back({rule.name, shape, rule.size});
    };
    std::visit(add, rule.shape);
  }
  for (const cases::WallRule& rule : request.walls) requests.walls.push_back(cases::wall_of(rule));
  for (const cases::EdgeRule& rule : request.edges) requests.edges.push_back(cases::edge_of(rule));
  if (!request.expression.empty())
    requests.formula = {sizing::SizeExpression(request.expression), request.minimum.value_or(0),
                        request.reference_length.value_or(1)};
  return requests;
}

/// What the conditions that the case gives, or names of patches, say of each face.
std::vector<sizing::FaceRole> roles_of(const cad::Model& model, const cases::SizingRequest& request) {
  using mesh::PatchType;
  using sizing::FaceRole;
  std::map<std::string, PatchType> types;
  for (const auto& [name, type] : request.patch_types) types[name] = type;
  const auto role_of = [&](const std::string& patch) {
    const auto found = types.find(patch);
    const bool is_given = found != types.end();
    const std::optional<PatchType> type = is_given ? found->second : mesh::patch_type_by_name(patch);
    if (!type) return FaceRole::open;
    if (*type == PatchType::farfield) return FaceRole::far_field;
    if (*type == PatchType::symmetry) return FaceRole::symmetry;
    return *type == PatchType::wall && is_given ? FaceRole::wall : FaceRole::open;
  };
  std::vector<FaceRole> of_patch, of_face;
  for (const std::string& patch : model.patches()) of_patch.push_back(role_of(patch));
  for (cad::FaceId f = 0; f < model.face_count(); ++f)
    of_face.push_back(of_patch[static_cast<std::size_t>(model.face(f).patch)]);
  return of_face;
}

SizedDomain size_domain_near(const parallel::Communicator& communicator, const cad::Model& model,
                             const cases::SizingRequest& asked, const Simplification& simplification,
                             Aim aim) {
  std::optional<sizing::SizingOptions>& near = aim.near;
  sizing::SizeRequests requests = requests_of(asked);
  requests.places = aim.seen.places;
  const sizing::GapDemand gaps = sizing::gap_demand(sizing::with_given({}, asked));
  const std::optional<double> target = asked.level ? std::nullopt : target_of(asked);
  const auto fields = target ? sizing::Fields::several : sizing::Fields::one;
  std::optional<sizing::FieldFactory> factory(
      std::in_place, sizing::SampledModel(communicator, model, roles_of(model, asked)), gaps, fields,
      std::move(requests));
  std::optional<LevelRequest> of_level;
  if (asked.level) of_level = apply_level(*factory, asked);
  const cases::SizingRequest& request = of_level ? of_level->request : asked;
  const std::vector<sizing::CoincidentFaces> coincident = sizing::find_coincident_faces(factory->sampled());
  const bool join = simplification.narrow_faces == cases::NarrowFaces::join;
  // A level resolves trailing edges, however thin.
  const bool automatic = !asked.level && simplification.trailing_edges == cad::TrailingEdges::automatic;
  // An estimate decides which faces are narrow; sizes are chosen for the model without them.
  if (!near && target && (join || automatic)) near = sizing::estimate_sizes(*factory, *target, request);
  const double width = near ? near->minimum : request.minimum.value_or(0);
  std::vector<sizing::TrailingEdge> edges;
  if (automatic) edges = sizing::find_trailing_edges(factory->sampled(), width);
  JoinedFaces what;
  if (join) {
    if (const auto joined = join_narrow_faces(communicator, model, width, what)) {
      sizing::FieldFactory of_joined(std::move(*factory), *joined);
      factory.emplace(std::move(of_joined));
    }
  }
  const Trial trial = try_sizes(*factory, request, near, aim.seen);
  TrailingEdgeReport report;
  if (!edges.empty())
    report =
        judge_trailing_edges(model, edges, trial_sizes(*factory, sizes_of_edges(*factory, request, trial)));
  std::optional<cad::Model> closed;
  parallel::agree(communicator, [&] { closed = close_trailing_edges(model, edges, report); });
  if (closed && trial.preliminary) near = trial.preliminary->options;
  SizedDomain sized = closed ? size_domain_near(communicator, *closed, request,
                                                {simplification.narrow_faces, cad::TrailingEdges::keep}, aim)
                             : finish(*factory, request, trial, std::move(what), aim);
  if (!closed)
    sized.findings.walls = report_walls(model, coincident, *factory, sized.field.scaled(asked.scale));
  judge_again(report, sized.sizes);
  sized.findings.edges = std::move(report);
  if (of_level) sized.level = of_level->level, sized.found = std::move(of_level->found);
  return sized;
}

/// All sizes times the factor, and what was found about them. The model stays: which faces are narrow and
/// which edges are closed is the same for all factors, so that meshes of a family have one geometry.
void scale_sizes(SizedDomain& sized, double factor) {
  sized.sizes = sizing::at_scale(sized.sizes, factor);
  sized.field = sized.field.scaled(factor);
  SizingFindings& findings = sized.findings;
  findings.counts = sizing::at_scale(findings.counts, factor);
  for (NamedBound& bound : findings.bounded) bound.degrees = std::min(180.0, factor * bound.degrees);
  if (!findings.features) return;
  FeatureReport& features = *findings.features;
  features.tetrahedra = findings.counts.tetrahedra;
  for (double* length : {&features.resolution.aspect, &features.resolution.floor,
                         &features.resolution.minimum, &features.resolution.gap_floor})
    *length *= factor;
  for (UnresolvedRegion& region : features.regions)
    region.surface_degrees = std::atan(std::tan(region.surface_degrees * std::numbers::pi / 180) / factor) *
                             180 / std::numbers::pi;
}

}  // namespace

void require_walls_apart(const SizedDomain& sized) {
  const std::string text = describe(sized.findings.walls.coincident);
  if (!text.empty()) throw parallel::CollectiveError(parallel::FailureKind::input, text);
}

SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const cases::SizingRequest& given, const Simplification& simplification,
                        sizing::FieldFor purpose) {
  const cases::SizingRequest request = cases::in_model_units(given);
  sizing::require_faces(model, requests_of(request));
  SizedDomain sized = size_domain_near(communicator, model, request, simplification, {purpose, {}});
  if (request.scale == 1) return sized;
  scale_sizes(sized, request.scale);
  if (communicator.is_root())
    parallel::log_info(fmt::format("sizing: all sizes times {:.6g} (sizing.scale)", request.scale));
  return sized;
}

std::optional<SizedDomain> size_again(const SizedDomain& sized, const cases::SizingRequest& given,
                                      const MadeSurface& made) {
  const cases::SizingRequest request = cases::in_model_units(given);
  const std::optional<double> target = request.level ? std::nullopt : target_of(request);
  if (!target || request.scale != 1) return std::nullopt;
  const double forecast = sized.findings.counts.tetrahedra;
  const bool has_lowered =
      !made.places.empty() && sizing::count_everywhere(made.field) - sizing::count_everywhere(sized.field) >
                                  (most_missed - 1) * *target;
  if (!has_lowered && !sizing::is_steep(sized.sizes) && *target > few_elements) return std::nullopt;
  const std::optional<double> count = made.count();
  const double asked = *target + sized.on_top, wanted = std::max(asked, forecast);
  const bool is_known = !sized.findings.missed_target.empty();
  const bool too_many =
      count && (*count > most_missed * wanted || (!is_known && *count > most_with_features * asked));
  if (!count || !(too_many || *count * most_missed < asked)) return std::nullopt;
  const parallel::Communicator& communicator = sized.field.communicator();
  if (communicator.is_root())
    parallel::log_info(fmt::format(
        "surface: about {:.2g} tetrahedra are to be made, not {:.2g}{}: sizes are chosen again", *count,
        wanted, made.places.empty() ? "" : fmt::format(" (sizes fell at {} places)", made.places.size())));
  Experience seen = sized.seen;
  seen.places.insert(seen.places.end(), made.places.begin(), made.places.end());
  {
    const sizing::SampledModel sampled(communicator, sized.model, roles_of(sized.model, request));
    const double before = sizing::count_tetrahedra(sampled, sized.field),
                 after = sizing::count_tetrahedra(sampled, made.field);
    seen.at_places += after - before;
    seen.bias = *count / (forecast / sized.seen.bias + after - before);
  }
  SizedDomain again = size_domain_near(communicator, sized.model, request,
                                       {cases::NarrowFaces::keep, cad::TrailingEdges::keep},
                                       {sizing::FieldFor::mesh, sized.sizes, std::move(seen)});
  again.findings.joined = sized.findings.joined;
  again.findings.edges = sized.findings.edges;
  judge_again(again.findings.edges, again.sizes);
  return again;
}

bool comes_nearer(double count, double other, const SizedDomain& sized, const cases::SizingRequest& request) {
  const double wanted = target_of(request).value_or(0) + sized.on_top;
  const auto error = [&](double each) { return std::abs(std::log(each / wanted)); };
  return error(count) < error(other);
}

void note_count(SizedDomain& sized, const cases::SizingRequest& request, double count) {
  const std::optional<double> target = request.level ? std::nullopt : target_of(request);
  std::string& text = sized.findings.missed_target;
  if (!target || !text.empty() || count < missed_target * (*target + sized.on_top)) return;
  text = fmt::format(
      "sizing.target_tetrahedra is {:.3g}, but about {:.2g} tetrahedra are to be made: at larger sizes walls "
      "or "
      "curves come too close to each other; the least target that this case meets is about {:.2g}",
      *target, count, count);
}

}  // namespace aeroloom::domain
