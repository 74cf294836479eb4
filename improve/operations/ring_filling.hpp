/// The best triangulation of the ring of vertices around an edge, with cones from both ends of the edge.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <span>

namespace aeroloom::improve {

/// Finds the triangulation whose worst tetrahedron is best, by dynamic programming (Shewchuk, Two discrete
/// optimization algorithms for the topological improvement of tetrahedral meshes, 2002, after Klincsek, Ann.
/// Discrete Math. 9, 1980, doi:10.1016/S0167-5060(08)70044-X).
class RingFilling {
public:
  static constexpr int largest_ring =
      8;  // a ring of 6 has 14 triangulations, one of 8 has 132; chosen, not measured

  /// The worst quality of the best triangulation; not above `floor` if none is better. The ring has 2 to
  /// largest_ring vertices, counter-clockwise seen from `end`. With 2 there is nothing to fill.
  double solve(const TetMesh& mesh, LocalIndex start, LocalIndex end, std::span<const LocalIndex> ring,
               double floor);
  /// Appends the tetrahedra of the last solution.
  void emit(std::vector<Corners>& tets) const;

private:
  struct Choice {
    double quality;
    int apex;  ///< of the triangle on this interval
  };
  double triangle_quality(const TetMesh& mesh, int i, int j, int k, double floor) const;
  void emit(int i, int k, std::vector<Corners>& tets) const;

  LocalIndex _start = 0, _end = 0;
  std::span<const LocalIndex> _ring;
  std::array<std::array<Choice, largest_ring>, largest_ring> _best;
};

}  // namespace aeroloom::improve
