/// Which sharp corners of faces are closed instead of being filled, and how far: sizes and surface have to
/// agree on it (docs/real_cad.md).
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::sizing {

/// Degrees below which a corner is closed where two faces lie beyond it, and where these meet already:
/// closed, they would do so twice, so that only corners are that nothing can fill. The first leaves no
/// triangle of less than 12 degrees in a corner, the second was chosen.
inline constexpr double closed_between_two_faces = 12, closed_where_faces_meet = 3;

/// A corner that opens by less than this many degrees is closed (surface/cusps/cusps.hpp): one triangle
/// that filled it would be a needle.
inline double closing_angle(const cad::Model& model, const cad::FaceCorner& corner) {
  switch (cad::neighbours_at_corner(model, corner)) {
    case cad::CornerNeighbours::two_faces:
      return closed_between_two_faces;
    case cad::CornerNeighbours::faces_that_meet:
      return closed_where_faces_meet;
    default:
      return 0;
  }
}

/// Corners are closed as far as their edges are apart by less than this. The mesh leaves the surface by half
/// of it, by all of it beside an exact plane: a twentieth of the smallest element is what joined narrow faces
/// may leave too.
inline double closing_gap(const SizingOptions& options) {
  constexpr double share_of_minimum = 0.05;
  return share_of_minimum * options.minimum;
}

}  // namespace aeroloom::sizing
