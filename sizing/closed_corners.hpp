/// Which sharp corners of faces are closed instead of being filled, and how far. What sizes and surface have
/// to agree on.
#pragma once

#include "aeroloom/cad/model/evaluation/face_corners.hpp"
#include "aeroloom/sizing/size_field.hpp"

namespace aeroloom::sizing {

/// A corner that opens by less than this many degrees is closed (surface/cusp_tips.hpp): one triangle that
/// filled it would be a needle. Less where the faces beyond meet already: closed, they would do so twice.
inline double closing_angle(const cad::Model& model, const cad::FaceCorner& corner) {
  switch (cad::beyond_corner(model, corner)) {
    case cad::BeyondCorner::two_faces:
      return 12;
    case cad::BeyondCorner::faces_that_meet:
      return 3;
    default:
      return 0;
  }
}

/// As far as their edges are apart by less than this. The mesh leaves the surface by half of it,
/// by all of it beside an exact plane.
inline double closing_gap(const SizingOptions& options) {
  return 0.05 * options.minimum;
}

}  // namespace aeroloom::sizing
