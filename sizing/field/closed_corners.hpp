/// Which sharp corners of faces are closed instead of filled with triangles, and how far. Size field and
/// surface mesher must agree on it (docs/real_cad.md).
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::sizing {

/// A corner is closed below this many degrees: 12 if two faces lie beyond it, 3 if these already meet there.
/// A corner of at least 12 degrees leaves no triangle of less than 12 degrees. The second value was chosen:
/// closing would make these faces meet twice, so it is kept to corners that nothing can fill.
inline constexpr double closed_between_two_faces = 12, closed_where_faces_meet = 3;

/// The angle in degrees below which a corner is closed (surface/cusps/cusps.hpp). A single triangle that
/// filled it would be a needle.
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

/// A corner is closed up to where its edges are this far apart. The mesh leaves the surface by half of that,
/// beside an exact plane by all of it. A twentieth of the smallest element is also what joined narrow faces
/// may leave.
inline double closing_gap(const SizingOptions& options) {
  constexpr double fraction_of_minimum = 0.05;
  return fraction_of_minimum * options.minimum;
}

}  // namespace aeroloom::sizing
