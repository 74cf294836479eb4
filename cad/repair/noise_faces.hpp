/// Faces and edges too small to be features: what a CAD program's rounding leaves behind. Seen by this folder
/// only.
#pragma once

#include "cad/repair/sampled_edge.hpp"

#include <optional>

#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// A face all of whose border is within the tolerance of another part of it.
struct NoiseFace {
  double widest = 0;  ///< largest distance from one part of the border to the nearest other one
  double length = 0;  ///< half its border
  Vec3 place;         ///< on its border
};

/// Nothing where the face is none. Concave and smooth-sided strips, rings and spots count alike; the face
/// must also have no more area than such a border can enclose.
std::optional<NoiseFace> examine_noise(const TopoDS_Face& face, double tolerance);

}  // namespace aeroloom::cad
