#include "sizing/choice/narrow_regions.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

/// Widths are measured at places this far apart, at least, over the widest.
constexpr double finest_width = 0.01;
/// Segments of narrow regions by which elements are counted are at most this many times as long as wide.
constexpr double aspect_of_segments = 8;
constexpr double largest_aspect = 1e30;  // finite, for widths of nothing

}  // namespace

std::vector<NarrowRegion> narrow_regions_below(const SampledModel& sampled, double width, double minimum) {
  SizingOptions options;
  options.minimum = minimum;
  options.maximum = width;
  options.narrow_minimum = finest_width * width;
  std::vector<NarrowRegion> mine;
  parallel::collectively(sampled.communicator(), ScopedCpu::As::task, [&] {
    for (const SampledFace& face : sampled.own_faces()) {
      NarrowRegion narrowest{face.id, width, {}};
      for (const NarrowSegment& part :
           narrow_segments(sampled.model(), face.facets, face.closed_corners, options, width)) {
        if (part.first_width < narrowest.width) narrowest = {face.id, part.first_width, part.first};
        if (part.last_width < narrowest.width) narrowest = {face.id, part.last_width, part.last};
      }
      if (narrowest.width < width) mine.push_back(narrowest);
    }
  });
  return sampled.communicator().gather_sorted(
      mine, [](const NarrowRegion& each) { return std::pair(each.width, each.face); });
}

std::vector<double> elements_along_narrow_regions(const SampledModel& sampled,
                                                  std::span<const double> aspects,
                                                  const SizingOptions& options) {
  struct FaceElements {
    FaceId face;
    std::int32_t aspect;
    double elements;
  };
  SizingOptions rough = options;
  rough.feature_aspect = aspect_of_segments;
  std::vector<FaceElements> mine;
  parallel::collectively(sampled.communicator(), ScopedCpu::As::task, [&] {
    SizingOptions sizes = options;
    for (const SampledFace& face : sampled.own_faces()) {
      const auto parts =
          narrow_segments(sampled.model(), face.facets, face.closed_corners, rough, options.minimum);
      for (std::size_t i = 0; i < aspects.size() && !parts.empty(); ++i) {
        sizes.feature_aspect = std::min(aspects[i], largest_aspect);
        double sum = 0;
        for (const NarrowSegment& part : parts) {
          const double width = 0.5 * (part.first_width + part.last_width);
          if (width >= options.minimum) continue;
          const double size = narrow_size(width, sizes), on_top = 1 - size / options.minimum;
          sum += distance(part.first, part.last) / size * on_top * on_top;
        }
        mine.push_back({face.id, static_cast<std::int32_t>(i), sum});
      }
    }
  });
  std::vector<double> elements(aspects.size());
  // Summed in the order of faces, whatever the number of ranks.
  for (const FaceElements& face : sampled.communicator().gather_sorted(mine, &FaceElements::face))
    elements[face.aspect] += face.elements;
  return elements;
}

}  // namespace aeroloom::sizing
