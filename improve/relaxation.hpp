/// Smoothing for the average: vertices whose tetrahedra are worse shaped than those of a lattice move to
/// where the sum of their inverse mean ratios is smaller, which counts the worst most.
#pragma once

#include "improve/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// One step of steepest descent of the sum of inverse mean ratios per vertex and pass, with a line search
/// (Freitag and Knupp, Int. J. Numer. Meth. Engng 53, 2002, doi:10.1002/nme.341). A vertex moves only
/// when the worst TetQuality around it does not fall.
class Relaxation {
public:
  /// Mean ratio on average around a vertex that stays where it is; a lattice has 0.95.
  static constexpr double good_enough = 0.93;

  /// Visits the free vertices in their order, `passes` times. Returns how many moves were made.
  std::int64_t run(TetMesh& mesh, int passes);

private:
  /// A tetrahedron at the vertex: the face opposite to it, counter-clockwise seen from the vertex.
  struct Cone {
    Vec3 a, b, c;
    Vec3 normal;     ///< of that face, twice its area long
    double squares;  ///< of its edges, summed
  };
  void score_vertices(const TetMesh& mesh);
  bool relax(TetMesh& mesh, LocalIndex v);
  /// The sum over the cones with their tips at p, negated; very small where one is not positive.
  double minus_inverse_ratios(Vec3 p) const;
  /// The same with its gradient.
  double minus_inverse_ratios(Vec3 p, Vec3& ascent) const;
  /// Moves the vertex of _star unless a quality falls below `least`.
  bool move(TetMesh& mesh, LocalIndex v, Vec3 to, double least);

  std::vector<float> _mean;  ///< mean ratio around each vertex
  std::vector<LocalIndex> _star;
  std::vector<double> _after;  ///< qualities of _star where it moves to
  std::vector<Cone> _cones;
};

}  // namespace aeroloom::improve
