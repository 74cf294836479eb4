// What users ask for at places and on patches, as part of what a sampler finds.
#include "aeroloom/parallel/communication/collective_error.hpp"
#include "aeroloom/sizing/curvature_size.hpp"
#include "aeroloom/sizing/model_sampler.hpp"
#include "parallel/observation/memory_limit.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {

namespace {

/// What a source in a region and the leaf around it take, about: a row of each, and of trees over both.
/// Added up, not measured.
constexpr double bytes_per_region_cell = 200;

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
  parallel::agree(_communicator, [&] {
    const parallel::ScopedCpu cpu(_clock, parallel::ScopedCpu::As::task);
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

}  // namespace aeroloom::sizing
