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
constexpr double finest_strip = 0.01;
/// Parts of strips by which their elements are counted are this many times as long as wide, at most.
constexpr double aspect_of_parts = 8;
constexpr double largest_aspect = 1e30;  // finite, for widths of nothing

}  // namespace

std::vector<Strip> strips_narrower_than(const SampledModel& sampled, double width, double minimum) {
  SizingOptions options;
  options.minimum = minimum;
  options.maximum = width;
  options.strip_minimum = finest_strip * width;
  std::vector<Strip> mine;
  parallel::collectively(sampled.communicator(), ScopedCpu::As::task, [&] {
    for (const SampledFace& face : sampled.own_faces()) {
      Strip narrowest{face.id, width, {}};
      for (const StripPart& part :
           strip_parts(sampled.model(), face.facets, face.closed_corners, options, width)) {
        if (part.first_width < narrowest.width) narrowest = {face.id, part.first_width, part.first};
        if (part.last_width < narrowest.width) narrowest = {face.id, part.last_width, part.last};
      }
      if (narrowest.width < width) mine.push_back(narrowest);
    }
  });
  std::vector<Strip> all = sampled.communicator().gather_sorted(
      mine, [](const Strip& each) { return std::pair(each.width, each.face); });
  return all;
}

std::vector<double> elements_along_strips(const SampledModel& sampled, std::span<const double> aspects,
                                          const SizingOptions& options) {
  struct FaceElements {
    FaceId face;
    std::int32_t aspect;
    double elements;

    static constexpr auto fields() {
      return std::tuple(&FaceElements::face, &FaceElements::aspect, &FaceElements::elements);
    }
  };
  SizingOptions rough = options;
  rough.feature_aspect = aspect_of_parts;
  std::vector<FaceElements> mine;
  parallel::collectively(sampled.communicator(), ScopedCpu::As::task, [&] {
    SizingOptions sizes = options;
    for (const SampledFace& face : sampled.own_faces()) {
      const auto parts =
          strip_parts(sampled.model(), face.facets, face.closed_corners, rough, options.minimum);
      for (std::size_t i = 0; i < aspects.size() && !parts.empty(); ++i) {
        sizes.feature_aspect = std::min(aspects[i], largest_aspect);
        double sum = 0;
        for (const StripPart& part : parts) {
          const double width = 0.5 * (part.first_width + part.last_width);
          if (width >= options.minimum) continue;
          const double size = strip_size(width, sizes), on_top = 1 - size / options.minimum;
          sum += distance(part.first, part.last) / size * on_top * on_top;
        }
        mine.push_back({face.id, static_cast<std::int32_t>(i), sum});
      }
    }
  });
  // Summed in the order of faces, whatever the number of ranks.
  std::vector<FaceElements> all = sampled.communicator().gather_sorted(
      mine, [](const FaceElements& each) { return std::pair(each.face, each.aspect); });
  std::vector<double> elements(aspects.size());
  for (const FaceElements& face : all) elements[face.aspect] += face.elements;
  return elements;
}

}  // namespace aeroloom::sizing
