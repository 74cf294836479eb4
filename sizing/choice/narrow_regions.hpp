/// Narrow regions of the faces of a model, between two of their edges.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The narrowest place of a face between two of its edges that share no vertex.
struct NarrowRegion {
  cad::FaceId face;
  double width;
  geometry::Vec3 place;
};

/// The faces with a place narrower than `width`, one narrow region each, the narrowest first. `minimum` tells
/// how far corners are closed. Collective.
std::vector<NarrowRegion> narrow_regions_below(const SampledModel& sampled, double width, double minimum);

/// The elements that narrow regions below the minimum add, for each of some aspects
/// (SizingOptions::feature_aspect). A pair of sides of length L has L / narrow_size() elements along each
/// side. An element of size s also costs the cone of growth around it, up to the minimum size m: (1 - s/m)^2
/// of the integral of 2 pi r / (s + k r)^3 to infinity, where sizes grow by k for each length. Collective.
std::vector<double> elements_along_narrow_regions(const SampledModel& sampled,
                                                  std::span<const double> aspects,
                                                  const SizingOptions& options);

}  // namespace aeroloom::sizing
