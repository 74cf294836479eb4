// What users ask for at places and on patches, as part of what a sampler finds.
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/choice/model_sampler.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/sources/formula_sources.hpp"
#include "sizing/sources/surface_demand.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
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
struct Demand {
  std::string key;
  std::function<double()> count;  ///< cells, about
  std::function<std::vector<SizeSource>(RankOf part, std::int64_t most)> find;
};

/// This rank's part of what a key of the case asks for, one more than `most` at most. Collective. What it
/// throws is about the case, not the geometry.
std::vector<SizeSource> find_demanded(const parallel::Communicator& communicator, const Demand& demand,
                                      double most) {
  const double room = static_cast<double>(parallel::node_memory_bytes()) / bytes_per_region_cell;
  const double own_room = room / communicator.size();
  std::vector<SizeSource> mine;
  try {
    parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
      const double count = demand.count();
      if (count <= room)
        mine =
            demand.find({communicator.rank(), communicator.size()}, std::llround(std::min(own_room, most)));
      if (count > room || static_cast<double>(mine.size()) > own_room)
        throw std::runtime_error(fmt::format(
            "{}: more elements than this machine can hold. Remedy: larger sizes there, in the model's unit",
            demand.key));
    });
  } catch (const parallel::CollectiveError& error) {
    if (error.kind() == parallel::FailureKind::input) throw std::invalid_argument(error.what());
    throw;
  }
  return mine;
}

}  // namespace

void ModelSampler::demand(std::vector<SizeLine> lines) {
  _demands.lines = std::move(lines);
  _estimates.clear();
}

SizingOptions ModelSampler::options_on(cad::FaceId face, const SizingOptions& options) const {
  const double asked = _asked_on_faces[face];
  if (asked <= 0) return options;
  SizingOptions here = options;
  here.surface_maximum = std::min(asked, largest_size(false, options));
  here.minimum = std::min(options.minimum, asked);
  if (_far_field[face]) here.maximum = std::min(options.maximum, asked);
  // What follows from the minimum where it is not given stays as it is.
  here.feature_minimum = smallest_feature_size(options);
  here.gap_minimum = smallest_gap_size(options);
  return here;
}

std::vector<SizeSource> ModelSampler::sample_regions(double coarser) const {
  double cells = 0;
  const SizeRegion* largest = nullptr;
  double most = 0;
  for (const SizeRegion& region : _demands.regions) {
    const double of_region = cells_in(_root, region, coarser * region.size);
    cells += of_region;
    if (of_region > most) most = of_region, largest = &region;
  }
  for (const SizeLine& line : _demands.lines) cells += points_along(line, coarser);
  const double room = static_cast<double>(parallel::node_memory_bytes()) / bytes_per_region_cell;
  if (_communicator.maximum(static_cast<std::int64_t>(cells / _communicator.size() > room)) != 0) {
    if (largest == nullptr)
      throw std::invalid_argument(fmt::format(
          "sizing.level: sizes along edges and wakes take about {:.2g} elements, more than this machine can "
          "hold. Remedy: a coarser level",
          cells));
    throw std::invalid_argument(fmt::format(
        "sizing.sources.{}: elements of {:.3g} there are about {:.2g}, more than this machine can "
        "hold. Remedy: a larger size, or a smaller region, in the model's unit",
        largest->name, largest->size, most));
  }
  std::vector<SizeSource> mine;
  parallel::collectively(_communicator, parallel::ScopedCpu::As::task, [&] {
    for (const SizeRegion& region : _demands.regions) {
      const auto more =
          sources_in(_root, region, coarser * region.size, _communicator.rank(), _communicator.size());
      mine.insert(mine.end(), more.begin(), more.end());
    }
    const auto lines = static_cast<int>(_demands.lines.size());
    for (int i = _communicator.rank(); i < lines; i += _communicator.size()) {
      const auto more = sources_along(_root, _demands.lines[static_cast<std::size_t>(i)], coarser);
      mine.insert(mine.end(), more.begin(), more.end());
    }
  });
  return mine;
}

void ModelSampler::lay_surfaces() {
  std::vector<SurfaceDemand> surfaces;
  const auto lay = [&](const std::string& key, std::vector<SizedTriangle> triangles, double reach) {
    surfaces.emplace_back(key, std::move(triangles), reach);
  };
  parallel::collectively(_communicator, parallel::ScopedCpu::As::repeated, [&] {
    for (const WallSize& wall : _demands.walls) {
      const std::vector<bool> named = faces_like(_model, wall.faces);
      std::vector<SizedTriangle> triangles;
      for (const Wall& facet : _walls->facets) {
        if (wall.faces.empty() ? !_far_field[facet.face] : named[facet.face])
          triangles.push_back({facet.corners, {wall.size, wall.size, wall.size}});
      }
      lay("sizing.walls." + wall.name, std::move(triangles), wall.distance);
    }
    for (const WakeSize& wake : _demands.wakes) {
      const WakeShape& shape = wake.shape;
      std::vector<std::array<geometry::Vec3, 2>> segments;
      if (shape.from && shape.to) segments.push_back({*shape.from, *shape.to});
      if (!shape.behind.empty())
        segments = trailing_segments(_model, faces_like(_model, shape.behind), normalized(shape.direction));
      lay("sizing.sources." + wake.name, wake_sheet(segments, wake), 0);
    }
    for (const EdgeSize& edge : _demands.edges)
      lay("sizing.edges." + edge.name, edges_asked_for(_model, edge), 0);
  });
  for (const SurfaceDemand& each : surfaces) {
    if (each.empty())
      throw std::invalid_argument(
          each.key() +
          ": the model has no edges there. Remedy: other patterns, another direction of a wake or another "
          "box "
          "of edges; geometry.trailing_edges: keep, where a trailing edge is named that would be closed");
  }
  _surfaces = std::make_shared<const std::vector<SurfaceDemand>>(std::move(surfaces));
}

std::vector<SizeSource> ModelSampler::sample_formula(const SizingOptions& options, double coarser,
                                                     double most) const {
  if (!_demands.formula) return {};
  const FormulaSize& formula = *_demands.formula;
  const FormulaSpace space{_model.bounds(), _body_box, coarser, coarser * options.maximum,
                           coarser * std::log(options.growth)};
  const Demand demand{"sizing.expression", [&] { return cells_of_formula(formula, space); },
                      [&](RankOf part, std::int64_t limit) {
                        return sources_of_formula(_root, formula, space, part.rank, part.ranks, limit);
                      }};
  return find_demanded(_communicator, demand, most);
}

std::vector<SizeSource> ModelSampler::sample_surfaces(const SizingOptions& options, double coarser,
                                                      double most) const {
  std::vector<SizeSource> mine;
  for (const SurfaceDemand& surface : *_surfaces) {
    const auto ask = [&](geometry::Vec3 middle, double half) { return surface.ask(middle, half, coarser); };
    const Demand demand{surface.key(), [&] { return surface.cells(_root, coarser); },
                        [&](RankOf part, std::int64_t limit) {
                          return sources_where(_root, ask, part, coarser * options.maximum, limit);
                        }};
    const auto more = find_demanded(_communicator, demand, most);
    mine.insert(mine.end(), more.begin(), more.end());
  }
  return mine;
}

std::vector<SizeSource> ModelSampler::sample_demands(const SizingOptions& options, double coarser) const {
  std::vector<SizeSource> mine = sample_regions(coarser);
  const auto add = [&](const std::vector<SizeSource>& more) {
    mine.insert(mine.end(), more.begin(), more.end());
  };
  add(sample_formula(options, coarser, any_number));
  add(sample_surfaces(options, coarser, any_number));
  return mine;
}

bool ModelSampler::demands_more_cells(const SizingOptions& options, double coarser, double most) const {
  double cells = 0;
  for (const SizeRegion& region : _demands.regions) cells += cells_in(_root, region, coarser * region.size);
  if (cells > most) return true;
  const std::size_t mine =
      sample_formula(options, coarser, most).size() + sample_surfaces(options, coarser, most).size();
  return static_cast<double>(_communicator.sum(static_cast<std::int64_t>(mine))) > most;
}

}  // namespace aeroloom::sizing
