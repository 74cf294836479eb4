/// Integrals over faces. Seen by this folder only.
#pragma once

#include "cad/model/evaluation/surface_evaluator.hpp"

#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// Integrals over a face oriented forward (its normal along du x dv).
struct FaceIntegrals {
  double area = 0;
  double flux = 0;   ///< a third of the flux of the position seen from the reference point: a volume
  Vec3 area_vector;  ///< of the normal: what the flux seen from elsewhere differs by
  Vec3 moment;       ///< of the position seen from the reference point: by the area, the face's centre
};

/// By Green's theorem from the parameter curves of the face's edges, all of the surface's range where it has
/// none; Gauss's rules between the knots, four digits on trimmed spline faces, mostly five.
FaceIntegrals integrate_face(const TopoDS_Face& face, const SurfaceEvaluator& surface, Vec3 reference);

}  // namespace aeroloom::cad
