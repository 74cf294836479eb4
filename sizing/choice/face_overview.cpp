// The number of elements that sizes ask of the faces of a model, told by facets alone: sizes that would take
// too long to sample are refused before that.
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/choice/field_factory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::sizing {

using cad::FaceId;
using parallel::ScopedCpu;

namespace {

/// Memory of the stages of sizes and surface for each triangle, at least (the built-in aircraft with 67,224:
/// 1,540 and 1,090).
constexpr double bytes_per_triangle = 200;

}  // namespace

std::vector<std::pair<FaceId, FaceSamples::Overview>> FieldFactory::look_over(const SizingOptions& options) {
  const ScopedCpu cpu(ScopedCpu::As::task);
  std::vector<std::pair<FaceId, FaceSamples::Overview>> seen;
  for (const SampledFace& face : _sampled.own_faces()) {
    FaceSamples once(model().is_planar(face.id));
    seen.emplace_back(face.id,
                      samples_of(face.id, once)
                          .overview(model(), face.id, face.facets, _sampled.bounds_far_field(face.id),
                                    _requests.options_on(_sampled, face.id, options)));
  }
  return seen;
}

FaceSamples& FieldFactory::samples_of(FaceId face, FaceSamples& once) {
  if (_fields == Fields::one) return once;
  return _samples.try_emplace(face, model().is_planar(face)).first->second;
}

std::vector<BoundedFace> FieldFactory::faces_bounded_by_minimum(const SizingOptions& options) {
  std::vector<BoundedFace> mine;
  parallel::agree(_sampled.communicator(), [&] {
    for (const auto& [face, seen] : look_over(options)) {
      if (seen.bounded_area > 0) mine.push_back({face, seen.bounded_area / seen.area, seen.degrees});
    }
  });
  return _sampled.communicator().gather_sorted(mine, &BoundedFace::face);
}

bool FieldFactory::has_more_parts(const SizingOptions& options, double most) {
  constexpr double most_of_face = 1e15;  // adding up must not overflow
  std::int64_t parts = 0;
  parallel::agree(_sampled.communicator(), [&] {
    for (const auto& [face, seen] : look_over(options))
      parts += std::llround(std::min(seen.parts, most_of_face));
  });
  return static_cast<double>(_sampled.communicator().sum(parts)) > most;
}

void FieldFactory::require_possible(const SizingOptions& options) {
  const geometry::Vec3 extents = _sampled.body_box().size();
  const double length = std::max({extents.x, extents.y, extents.z});
  if (options.minimum > length) {
    throw std::invalid_argument(fmt::format(
        "sizing: the smallest size is {:.6g}, but the body is only {:.6g} long. Remedy: a size in "
        "the model's unit",
        options.minimum, length));
  }
  struct Count {
    double triangles = 0;
    cad::FaceId face = cad::no_entity;
  };
  Count mine, most;
  parallel::agree(_sampled.communicator(), [&] {
    for (const auto& [face, seen] : look_over(options)) {
      mine.triangles += seen.triangles;
      if (seen.triangles > most.triangles) most = {seen.triangles, face};
    }
  });
  const double all = _sampled.communicator().sum(mine.triangles);
  const double room = static_cast<double>(parallel::node_memory_bytes()) / bytes_per_triangle;
  if (_sampled.communicator().maximum(static_cast<std::int64_t>(all > room)) == 0) return;
  const std::vector<Count> heaviest =
      _sampled.communicator().all_gather_items<Count>(std::span<const Count>(&most, 1));
  for (const Count& each : heaviest)
    if (each.triangles > most.triangles) most = each;
  throw std::invalid_argument(fmt::format(
      "sizing: these sizes (minimum {:.3g}, maximum {:.3g}) ask for about {:.2g} triangles, {:.2g} of them "
      "on "
      "face '{}': more than this machine can hold. Remedy: larger ones, in the model's unit; the body is "
      "{:.3g} long",
      options.minimum, options.maximum, all, most.triangles, model().face(most.face).name, length));
}

}  // namespace aeroloom::sizing
