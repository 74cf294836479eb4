/// Faces of the body that lie on one another: what no size can part.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// Two faces that lie on one another, or nearly so.
struct CoincidentFaces {
  cad::FaceId first, second;
  double area;           ///< over which they do, about
  geometry::Vec3 place;  ///< on the first one
  double apart;          ///< how far they are from each other there, at most

  static constexpr auto fields() {
    return std::tuple(&CoincidentFaces::first, &CoincidentFaces::second, &CoincidentFaces::area,
                      &CoincidentFaces::place, &CoincidentFaces::apart);
  }
};

/// Pairs of faces of the body, none between regions, that are nearer than 2e-5 of the body's extent, or with
/// a gap of up to 2e-4 that is meshed and would take ten million triangles, over more than a twentieth of the
/// smaller one's area; not where they run together towards a common edge. The largest areas first. By facets
/// and projections. For the model before any of its faces were joined. Collective.
std::vector<CoincidentFaces> find_coincident_faces(const SampledModel& sampled);

}  // namespace aeroloom::sizing
