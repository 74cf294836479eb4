/// Integrals over faces. Internal to cad/.
#pragma once

#include "cad/model/evaluation/surface_evaluator.hpp"

#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// Integrals over a face oriented forward, with its normal along du x dv.
struct FaceIntegrals {
  double area = 0;
  double flux =
      0;  ///< flux of the position relative to the reference point, divided by three; it adds up to volumes
  Vec3 area_vector;  ///< integral of the normal; moves the flux to another reference point
  Vec3 moment;       ///< integral of the position relative to the reference point; over the area, the centre
};

/// By Green's theorem along the parameter curves of the edges; without edges over the whole surface. Gauss's
/// rules are applied between the knots. Trimmed spline faces are accurate to four digits, mostly five.
FaceIntegrals integrate_face(const TopoDS_Face& face, const SurfaceEvaluator& surface, Vec3 reference);

}  // namespace aeroloom::cad
