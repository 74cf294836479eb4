/// Faces of the body that lie on one another. No size can mesh what is between them.
#pragma once

#include "sizing/choice/sampled_model.hpp"

#include <vector>

namespace aeroloom::sizing {

/// Two faces that lie on one another, or nearly.
struct CoincidentFaces {
  cad::FaceId first, second;
  double area;           ///< of the overlap, about
  geometry::Vec3 place;  ///< on the first one
  double apart;          ///< their largest distance there
  double triangles =
      0;  ///< on each, as small as a meshed gap between them asks for; 0: no volume between them
};

/// Finds pairs of faces of the body that are too near each other over more than a twentieth of the smaller
/// one. Too near is less than 2e-5 of the extent of the body. A meshed gap of up to 2e-4 is too near as well,
/// if it would take ten million triangles. Faces between regions do not count, nor places where faces run
/// towards a common edge, nor places that are themselves narrower than what is too near: along the end of a
/// sharp trailing edge. The largest areas come first. Uses facets and projections. The model must have no
/// joined faces yet. Collective.
std::vector<CoincidentFaces> find_coincident_faces(const SampledModel& sampled);

}  // namespace aeroloom::sizing
