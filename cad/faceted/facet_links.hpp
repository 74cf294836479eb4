/// Neighbours of triangles in a complex. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "geometry/half_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// The position of a half-edge on a curve. A half-edge is a side of one triangle, with its direction.
struct CurveSide {
  std::int32_t curve = no_entity;  ///< no_entity: the half-edge lies inside a face
  std::int32_t side = 0;           ///< from point `side` of the curve to the next point
  bool along = true;               ///< same direction as the curve
};

struct FacetLinks {
  std::vector<CurveSide> on_curve;         ///< per half-edge
  std::vector<geometry::HalfEdge> inside;  ///< per half-edge, its twin in the same face; -1 on curves
};

/// Throws CadError if a side inside a face does not have exactly two triangles of that face.
FacetLinks link_facets(const FacetComplex& complex);

/// The half-edge that follows `h` on the border of its face.
geometry::HalfEdge next_on_border(const FacetLinks& links, geometry::HalfEdge h);

inline std::int32_t start_of(const FacetComplex& complex, geometry::HalfEdge h) {
  return complex.triangles[h / 3][h % 3];
}
inline std::int32_t end_of(const FacetComplex& complex, geometry::HalfEdge h) {
  return start_of(complex, geometry::next_half_edge(h));
}
inline std::array<Vec3, 3> corners_of(const FacetComplex& complex, std::int32_t triangle) {
  const auto& [a, b, c] = complex.triangles[triangle];
  return {complex.points[a], complex.points[b], complex.points[c]};
}

}  // namespace aeroloom::cad
