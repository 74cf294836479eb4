/// Finds faces that are too narrow to be features, as rounding in CAD programs leaves them. Internal to cad/.
#pragma once

#include "cad/repair/sampled_edge.hpp"

#include <optional>

#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// A face whose border is everywhere within the tolerance of another part of the border.
struct NoiseFace {
  double widest = 0;  ///< largest distance from one part of the border to the nearest other part
  double length = 0;  ///< half the length of the border
  Vec3 place;         ///< a point on the border
};

/// Examines one face; empty if it is no noise. Strips, rings and spots all count. The area must also be small
/// for the length of the border.
std::optional<NoiseFace> examine_noise(const TopoDS_Face& face, double tolerance);

}  // namespace aeroloom::cad
