/// Narrow regions of the faces of a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The narrowest place of a face between two of its edges, or parts of one (narrow_segments()).
struct NarrowRegion {
  cad::FaceId face;
  double width;
  geometry::Vec3 place;
};

/// The faces with a place narrower than `width`, one narrow region each, the narrowest first. `minimum`: the
/// size by which sharp corners count as closed, with edges merged near the vertex. Collective.
std::vector<NarrowRegion> narrow_regions_below(const SampledModel& sampled, double width, double minimum);

/// What narrow regions below the minimum size m add to the mesh, for each of some aspects
/// (SizingOptions::feature_aspect). Returns the sum of L/s (1 - s/m)^2 over parts of length L with elements
/// of size s = narrow_size(); the caller scales it to tetrahedra. The square is for the cone of growth around
/// an element, which ends at size m. Collective.
std::vector<double> elements_along_narrow_regions(const SampledModel& sampled,
                                                  std::span<const double> aspects,
                                                  const SizingOptions& options);

}  // namespace aeroloom::sizing
