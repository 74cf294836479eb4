/// Sliding of a boundary vertex along its CAD face or curve to improve the worst tetrahedron around it.
#pragma once

#include "cad/model/evaluation/point_locator.hpp"
#include "improve/operations/boundary_change.hpp"
#include "improve/operations/smoothing.hpp"

#include <vector>

namespace aeroloom::improve {

/// Slides vertices that are not shared. The vertex stays on the CAD, and its triangles change within the
/// limits of boundary_change.hpp.
class Sliding {
public:
  Sliding(cad::PointLocator& locator, const ChangeLimits& limits) : _locator(locator), _smoothing(limits) {}

  /// Moves a vertex inside a CAD face or curve if this noticeably raises the worst quality around it. False
  /// for all other vertices. `star` receives its tetrahedra.
  bool slide(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star);

private:
  bool collect_triangles(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star);
  double mean_distance(const TetMesh& mesh, LocalIndex vertex) const;

  cad::PointLocator& _locator;
  Smoothing _smoothing;
  std::vector<TrianglePoints> _triangles;  ///< at the vertex, which comes first
};

}  // namespace aeroloom::improve
