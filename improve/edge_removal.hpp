/// Removal of an interior edge: the tetrahedra around it are replaced by the best pair of cones over a
/// triangulation of their ring (3-2 and 4-4 swaps and their generalisation).
#pragma once

#include "improve/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// Finds the triangulation of the ring whose worst tetrahedron is best, by dynamic programming over its
/// intervals (Shewchuk, Two discrete optimization algorithms for the topological improvement of tetrahedral
/// meshes, 2002, after Klincsek, Ann. Discrete Math. 9, 1980, doi:10.1016/S0167-5060(08)70044-X).
class EdgeRemoval {
public:
  static constexpr int largest_ring = 8;

  /// Proposes the removal of edge i of tetrahedron t. False when nothing beats both the cavity as it is and
  /// `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, int edge, double floor, Cavity& cavity);

private:
  struct Choice {
    double quality;
    int apex;  ///< of the triangle on this interval
  };
  double triangle_quality(const TetMesh& mesh, int i, int j, int k, double floor) const;
  void emit_triangles(int i, int k, Cavity& cavity) const;

  Shell _shell;
  std::array<std::array<Choice, largest_ring>, largest_ring> _best;
};

}  // namespace aeroloom::improve
