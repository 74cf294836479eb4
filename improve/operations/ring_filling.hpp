/// The best pair of cones over a triangulation of a ring of vertices, from the two ends of the edge it
/// surrounds.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <span>

namespace aeroloom::improve {

/// Finds the triangulation of the ring whose worst tetrahedron is best, by dynamic programming over its
/// intervals (Shewchuk, Two discrete optimization algorithms for the topological improvement of tetrahedral
/// meshes, 2002, after Klincsek, Ann. Discrete Math. 9, 1980, doi:10.1016/S0167-5060(08)70044-X).
class RingFilling {
public:
  static constexpr int largest_ring =
      8;  // of 6 vertices there are 14 fillings, of 8 there are 132; chosen, not measured

  /// The worst quality of the best filling; not above `floor` where none is better. The ring has 2 to
  /// largest_ring vertices, counter-clockwise seen from `end`; one of 2 has nothing to fill.
  double solve(const TetMesh& mesh, LocalIndex start, LocalIndex end, std::span<const LocalIndex> ring,
               double floor);
  /// Appends the tetrahedra of the last filling.
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
