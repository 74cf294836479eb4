#include "pipeline/domain/level_sizes.hpp"

#include "cad/model/patches.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "sizing/lifting/level_requests.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

using sizing::Level;

/// The request with bounds of a level where the user gave none.
cases::SizingRequest with_bounds(const cases::SizingRequest& request, const sizing::GivenSizes& bounds) {
  cases::SizingRequest result = request;
  const auto fill = [&](std::optional<double> sizing::GivenSizes::*bound) {
    if (!(result.*bound)) result.*bound = bounds.*bound;
  };
  for (const auto bound : {&sizing::GivenSizes::minimum, &sizing::GivenSizes::maximum,
                           &sizing::GivenSizes::feature_minimum, &sizing::GivenSizes::surface_maximum,
                           &sizing::GivenSizes::growth, &sizing::GivenSizes::curvature_angle})
    fill(bound);
  // What a user gives binds what follows from the level.
  if (!request.surface_maximum) {
    if (request.maximum) result.surface_maximum = std::min(*result.surface_maximum, *request.maximum);
    if (request.minimum) result.surface_maximum = std::max(*result.surface_maximum, *request.minimum);
  }
  if (!request.minimum)
    result.minimum = std::min({*result.minimum, *result.surface_maximum, *result.maximum});
  if (!request.maximum)
    result.maximum = std::max({*result.maximum, *result.surface_maximum, *result.minimum});
  if (!request.feature_minimum) result.feature_minimum = result.minimum;
  result.level.reset();
  return result;
}

/// A model under one level after another.
class Levels {
public:
  Levels(sizing::FieldFactory& factory, const cases::SizingRequest& request)
      : _factory(factory),
        _request(request),
        _flow(normalized(request.flow.value_or(cases::default_flow))),
        _bodies(sizing::find_lifting_bodies(factory.sampled(), _flow, request.lifting)) {
    if (!_bodies.elements.empty()) return;
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format(
            "sizing.level: no trailing edge was found behind which a body ends along the flow "
            "({:.3g}, {:.3g}, {:.3g}): neither a blunt strip nor a sharp edge of the CAD. Remedy: "
            "sizing.flow, the direction of the flow, sizing.lifting, faces with trailing edges, or sizes of "
            "your own in place of the level",
            _flow.x, _flow.y, _flow.z));
  }

  const sizing::LiftingBodies& bodies() const { return _bodies; }
  sizing::LevelSizes sizes(Level level) const {
    return sizing::sizes_of(level, _request.family, _request.solver);
  }
  /// The request with the level's bounds; what it asks for along lines the factory's fields ask for from now
  /// on.
  cases::SizingRequest take(Level level) {
    _factory.request_lines(sizing::level_lines(_factory.model(), _bodies, sizes(level), _flow));
    return with_bounds(_request, sizing::level_bounds(_factory.model(), _bodies, sizes(level)));
  }
  /// The finest one up to that asked for which the budget holds. Counts of a family go with the cube of its
  /// factors, so the coarsest decides where to look; the level found is counted itself.
  Level finest_within(double budget) {
    const std::span<const Level> all = sizing::levels_like(*_request.level);
    const double coarsest = count(all.front());
    if (coarsest > budget)
      throw parallel::CollectiveError(
          parallel::FailureKind::input,
          fmt::format(
              "sizing.budget: {:.3g} tetrahedra do not hold level {}, which takes about {:.2g}. "
              "Remedy: a larger budget, sizing.solver: cell, {}"
              "or sizes of your own in place of the level",
              budget, sizing::name_of(all.front()), coarsest,
              cad::is_around_bodies(_factory.model()) ? "a nearer far field (farfield.extent), " : ""));
    auto found = std::find(all.begin(), all.end(), *_request.level);
    const double factor = sizes(all.front()).factor;
    while (found != all.begin() && coarsest * std::pow(factor / sizes(*found).factor, 3) > budget) --found;
    const auto asked = std::find(all.begin(), all.end(), *_request.level);
    if (found == all.begin() || count(*found) <= budget) {
      // Counts may grow by less than the cube, above all where sizes are given that do not follow the level.
      while (found != asked && count(*(found + 1)) <= budget) ++found;
      return *found;
    }
    do --found;
    while (found != all.begin() && count(*found) > budget);
    return *found;
  }

private:
  double count(Level level) {
    const sizing::SizingOptions options = sizing::with_given({}, take(level));
    return sizing::apply_sizes(_factory, options, sizing::FieldFor::forecast).counts.tetrahedra;
  }

  sizing::FieldFactory& _factory;
  const cases::SizingRequest& _request;
  geometry::Vec3 _flow;
  sizing::LiftingBodies _bodies;
};

/// Where the file is the fluid, no key moves the far field.
void warn_of_near_far_field(const sizing::FieldFactory& factory, const LevelFindings& found,
                            double semispans) {
  constexpr double near = 0.9;  // of the distance that the level has: boxes are measured along axes
  const cad::Model& model = factory.model();
  for (cad::FaceId f = 0; f < model.face_count(); ++f)
    if (model.is_far_field(f)) return;
  if (found.far_field > near * semispans || !factory.sampled().communicator().is_root()) return;
  parallel::log_warning(
      fmt::format("sizing.level: the level has its far field {:.3g} semispans away, that of the file is "
                  "{:.2g} away",
                  semispans, found.far_field));
}

}  // namespace

LevelRequest apply_level(sizing::FieldFactory& factory, const cases::SizingRequest& request) {
  Levels levels(factory, request);
  const Level level = request.budget ? levels.finest_within(*request.budget) : *request.level;
  const sizing::LiftingBodies& bodies = levels.bodies();
  LevelRequest result{levels.take(level), level,
                      describe_level(factory.model(), bodies, levels.sizes(level))};
  if (factory.sampled().communicator().is_root())
    parallel::log_info(fmt::format(
        "sizing: level {}: {} trailing edges, reference chord {:.4g}, semispan {:.4g}; {:.3g} % of the local "
        "chord at leading and trailing edges, at most {:.3g} on walls, growth {:.3g}",
        sizing::name_of(level), bodies.elements.size(), bodies.reference_chord, bodies.semispan,
        100 * levels.sizes(level).edge, *result.request.surface_maximum, *result.request.growth));
  warn_of_near_far_field(factory, result.found, levels.sizes(level).far_field);
  return result;
}

}  // namespace aeroloom::domain
