#include "sizing/choice/request_sampler.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/sources/surface_request.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {

namespace {

/// What a source in a region and the leaf around it take, about: a row of each, and of trees over both.
/// Added up, not measured.
constexpr double bytes_per_region_cell = 200;
/// In place of a bound to a number of cells.
constexpr double any_number = 1e18;

/// Something of the case that asks for sizes in cells.
struct Request {
  std::string key;
  std::function<double()> count;  ///< cells, about
  std::function<std::vector<SizeSource>(RankOf part, std::int64_t most)> find;
};

/// This rank's part of what a key of the case asks for, one more than `most` at most. Collective. What it
/// throws is about the case, not the geometry.
std::vector<SizeSource> find_requested(const SampledModel& sampled, const Request& request, double most) {
  const parallel::Communicator& communicator = sampled.communicator();
  const double room = static_cast<double>(parallel::node_memory_bytes()) / bytes_per_region_cell;
  const double own_room = room / communicator.size();
  std::vector<SizeSource> mine;
  try {
    parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
      const double count = request.count();
      if (count <= room)
        mine =
            request.find({communicator.rank(), communicator.size()}, std::llround(std::min(own_room, most)));
      if (count > room || static_cast<double>(mine.size()) > own_room)
        throw std::runtime_error(fmt::format(
            "{}: more elements than this machine can hold. Remedy: larger sizes there, in the model's unit",
            request.key));
    });
  } catch (const parallel::CollectiveError& error) {
    if (error.kind() == parallel::FailureKind::input) throw std::invalid_argument(error.what());
    throw;
  }
  return mine;
}

}  // namespace

RequestSampler::RequestSampler(const SampledModel& sampled, SizeRequests requests)
    : _requests(std::move(requests)), _asked_on_faces(sizes_on_faces(sampled.model(), _requests)) {
  lay_surfaces(sampled);
}

RequestSampler::RequestSampler(RequestSampler&& before, const SampledModel& joined)
    : _requests(std::move(before._requests)),
      _asked_on_faces(sizes_on_faces(joined.model(), _requests)),
      _surfaces(std::move(before._surfaces)),
      _wakes(std::move(before._wakes)) {}

SizingOptions RequestSampler::options_on(const SampledModel& sampled, cad::FaceId face,
                                         const SizingOptions& options) const {
  const double asked = _asked_on_faces[face];
  if (asked <= 0) return options;
  SizingOptions here = options;
  here.surface_maximum = std::min(asked, largest_size(false, options));
  here.minimum = std::min(options.minimum, asked);
  if (sampled.bounds_far_field(face)) here.maximum = std::min(options.maximum, asked);
  // What follows from the minimum where it is not given stays as it is.
  here.feature_minimum = smallest_feature_size(options);
  here.gap_minimum = smallest_gap_size(options);
  return here;
}

std::vector<SizeSource> RequestSampler::sample_regions(const SampledModel& sampled, double coarsening,
                                                       Requests which) const {
  static const std::vector<SizeRegion> none;
  const std::vector<SizeRegion>& regions = which == Requests::all ? _requests.regions : none;
  const parallel::Communicator& communicator = sampled.communicator();
  double cells = 0;
  const SizeRegion* largest = nullptr;
  double most = 0;
  for (const SizeRegion& region : regions) {
    const double of_region = cells_in(sampled.root(), region, coarsening * region.size);
    cells += of_region;
    if (of_region > most) most = of_region, largest = &region;
  }
  for (const SizeLine& line : _requests.lines) cells += points_along(line, coarsening);
  const double room = static_cast<double>(parallel::node_memory_bytes()) / bytes_per_region_cell;
  if (communicator.maximum(static_cast<std::int64_t>(cells / communicator.size() > room)) != 0) {
    if (largest == nullptr)
      throw std::invalid_argument(fmt::format(
          "sizing.level: sizes along edges and wakes take about {:.2g} elements, more than this machine can "
          "hold. Remedy: a coarsening level",
          cells));
    throw std::invalid_argument(fmt::format(
        "sizing.sources.{}: elements of {:.3g} there are about {:.2g}, more than this machine can "
        "hold. Remedy: a larger size, or a smaller region, in the model's unit",
        largest->name, largest->size, most));
  }
  std::vector<SizeSource> mine;
  parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
    for (const SizeRegion& region : regions) {
      const auto more = sources_in(sampled.root(), region, coarsening * region.size, communicator.rank(),
                                   communicator.size());
      mine.insert(mine.end(), more.begin(), more.end());
    }
    const auto lines = static_cast<int>(_requests.lines.size());
    for (int i = communicator.rank(); i < lines; i += communicator.size()) {
      const auto more =
          sources_along(sampled.root(), _requests.lines[static_cast<std::size_t>(i)], coarsening);
      mine.insert(mine.end(), more.begin(), more.end());
    }
  });
  return mine;
}

void RequestSampler::lay_surfaces(const SampledModel& sampled) {
  std::vector<SurfaceRequest> surfaces, wakes;
  parallel::collectively(sampled.communicator(), parallel::ScopedCpu::As::repeated, [&] {
    for (const WallSize& wall : _requests.walls) {
      const std::vector<bool> named = faces_like(sampled.model(), wall.faces);
      std::vector<SizedTriangle> triangles;
      for (const ModelFacet& facet : sampled.facets().items) {
        if (wall.faces.empty() ? !sampled.bounds_far_field(facet.face) : named[facet.face])
          triangles.push_back({facet.corners, {wall.size, wall.size, wall.size}});
      }
      surfaces.emplace_back("sizing.walls." + wall.name, std::move(triangles), wall.distance);
    }
    for (const WakeSize& wake : _requests.wakes) {
      const WakeShape& shape = wake.shape;
      std::vector<std::array<geometry::Vec3, 2>> segments;
      if (shape.from && shape.to) segments.push_back({*shape.from, *shape.to});
      if (!shape.behind.empty())
        segments = trailing_segments(sampled.model(), faces_like(sampled.model(), shape.behind),
                                     normalized(shape.direction));
      wakes.emplace_back("sizing.sources." + wake.name, wake_sheet(segments, wake), 0);
    }
    for (const EdgeSize& edge : _requests.edges)
      surfaces.emplace_back("sizing.edges." + edge.name, edges_asked_for(sampled.model(), edge), 0);
  });
  const auto require_edges = [](const SurfaceRequest& each) {
    if (each.empty())
      throw std::invalid_argument(
          each.key() +
          ": the model has no edges there. Remedy: other patterns, another direction of a wake or another "
          "box "
          "of edges; geometry.trailing_edges: keep, where a trailing edge is named that would be closed");
  };
  std::for_each(surfaces.begin(), surfaces.end(), require_edges);
  std::for_each(wakes.begin(), wakes.end(), require_edges);
  _surfaces = std::move(surfaces);
  _wakes = std::move(wakes);
}

std::vector<SizeSource> RequestSampler::sample_cells(const SampledModel& sampled,
                                                     const SizingOptions& options, double coarsening,
                                                     Requests which, double most) const {
  std::vector<SizeSource> mine;
  const auto add = [&](const Request& request) {
    const auto more = find_requested(sampled, request, most);
    mine.insert(mine.end(), more.begin(), more.end());
  };
  if (_requests.formula) {
    const FormulaSize& formula = *_requests.formula;
    const FormulaSpace space{sampled.model().bounds(), sampled.body_box(), coarsening,
                             coarsening * options.maximum, coarsening * std::log(options.growth)};
    add({"sizing.expression", [&] { return cells_of_formula(formula, space); },
         [&](RankOf part, std::int64_t limit) {
           return sources_of_formula(sampled.root(), formula, space, part.rank, part.ranks, limit);
         }});
  }
  const auto add_surface = [&](const SurfaceRequest& surface) {
    const auto ask = [&](geometry::Vec3 middle, double half) {
      return surface.request_in(middle, half, coarsening);
    };
    add({surface.key(), [&] { return surface.cells(sampled.root(), coarsening); },
         [&](RankOf part, std::int64_t limit) {
           return sources_where(sampled.root(), ask, part, coarsening * options.maximum, limit);
         }});
  };
  std::for_each(_surfaces.begin(), _surfaces.end(), add_surface);
  if (which == Requests::all) std::for_each(_wakes.begin(), _wakes.end(), add_surface);
  return mine;
}

std::vector<SizeSource> RequestSampler::sample(const SampledModel& sampled, const SizingOptions& options,
                                               double coarsening, Requests which) const {
  std::vector<SizeSource> mine = sample_regions(sampled, coarsening, which);
  const std::vector<SizeSource> in_cells = sample_cells(sampled, options, coarsening, which, any_number);
  mine.insert(mine.end(), in_cells.begin(), in_cells.end());
  if (!sampled.communicator().is_root()) return mine;
  for (const SizeSource& place : _requests.places) mine.push_back({place.point, coarsening * place.size});
  return mine;
}

bool RequestSampler::ask_for_more_cells(const SampledModel& sampled, const SizingOptions& options,
                                        double coarsening, Requests which, double most) const {
  double cells = 0;
  if (which == Requests::all)
    for (const SizeRegion& region : _requests.regions)
      cells += cells_in(sampled.root(), region, coarsening * region.size);
  if (cells > most) return true;
  const std::size_t mine = sample_cells(sampled, options, coarsening, which, most).size();
  return static_cast<double>(sampled.communicator().sum(static_cast<std::int64_t>(mine))) > most;
}

}  // namespace aeroloom::sizing
