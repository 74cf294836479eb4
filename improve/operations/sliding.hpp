/// Moving a vertex of the boundary along its CAD face or curve so that the worst of the tetrahedra around it
/// gets better.
#pragma once

#include "cad/model/evaluation/point_locator.hpp"
#include "improve/operations/boundary_change.hpp"
#include "improve/operations/smoothing.hpp"

#include <vector>

namespace aeroloom::improve {

/// Slides vertices that no other piece knows. Each triangle stays a gentle change of what it was
/// (boundary_change.hpp), and the vertex stays on the CAD.
class Sliding {
public:
  Sliding(cad::PointLocator& locator, const ChangeLimits& limits) : _locator(locator), _smoothing(limits) {}

  /// Moves a vertex inside a CAD face or curve where that lifts the worst quality around it noticeably; false
  /// for all others. `star` receives its tetrahedra.
  bool slide(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star);

private:
  bool collect_triangles(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star);
  double mean_distance(const TetMesh& mesh, LocalIndex vertex) const;

  cad::PointLocator& _locator;
  Smoothing _smoothing;
  std::vector<TrianglePoints> _triangles;  ///< at the vertex, which comes first
};

}  // namespace aeroloom::improve
