/// Normals and curvatures at the points of a face of facets. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/half_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// Per point, what the facets around it tell of the surface that they stand for.
struct FacetShape {
  std::vector<Vec3> normals;  ///< unit, weighted by angles; slivers without a direction left out
  /// By absolute value. Of the tensors that normals change by over each triangle (Rusinkiewicz, Estimating
  /// curvatures and their derivatives on triangle meshes, 3DPVT 2004, doi:10.1109/TDPVT.2004.1335277), by
  /// areas; none is much larger than around it.
  std::vector<PrincipalCurvatures> curvatures;
};

/// Triangles of one face, all with the normal out of it.
FacetShape shape_of(const std::vector<Vec3>& points, const std::vector<geometry::TriangleCorners>& triangles);

}  // namespace aeroloom::cad
