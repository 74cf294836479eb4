/// Narrow regions of the faces of a model, between two of their edges.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// The narrowest place of a face between two of its edges that share no vertex.
struct Strip {
  cad::FaceId face;
  double width;
  geometry::Vec3 place;

  static constexpr auto fields() { return std::tuple(&Strip::face, &Strip::width, &Strip::place); }
};

/// One for each face with strips narrower than that, by width: the least distance between two of its edges.
/// `minimum` tells how far corners are closed. Collective.
std::vector<Strip> strips_narrower_than(const SampledModel& sampled, double width, double minimum);

/// Elements along both sides of all strips narrower than the minimum, about, for each of some aspects
/// (SizingOptions::feature_aspect): lengths over strip_size(). Each counts by what grows around it until
/// sizes are the minimum: where they grow by k a length from s to m, the integral of 2 pi r / (s + k r)^3
/// is that to infinity times (1 - s/m)^2. Collective.
std::vector<double> elements_along_strips(const SampledModel& sampled, std::span<const double> aspects,
                                          const SizingOptions& options);

}  // namespace aeroloom::sizing
