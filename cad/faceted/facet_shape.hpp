/// Normals and curvatures at the points of a faceted face. Internal to cad/faceted/.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/half_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// Estimates at each point for the smooth surface that the triangles approximate.
struct FacetShape {
  std::vector<Vec3> normals;  ///< unit, weighted by angles; slivers do not count
  /// Absolute values, from the change of normals over each triangle (Rusinkiewicz, Estimating curvatures and
  /// their derivatives on triangle meshes, 3DPVT 2004, doi:10.1109/TDPVT.2004.1335277), averaged by area.
  /// Outliers are cut.
  std::vector<PrincipalCurvatures> curvatures;
};

/// Triangles of one face. Their normals point out of the face's region.
FacetShape shape_of(const std::vector<Vec3>& points, const std::vector<geometry::TriangleCorners>& triangles);

}  // namespace aeroloom::cad
