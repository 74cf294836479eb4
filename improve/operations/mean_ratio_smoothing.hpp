/// Smoothing for average quality. Vertices whose tetrahedra are shaped worse than those of a lattice move to
/// lower the sum of their inverse mean ratios.
#pragma once

#include "improve/operations/inverse_ratios.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// Makes one step of steepest descent with a line search per vertex and pass (Freitag and Knupp, Int. J.
/// Numer. Meth. Engng 53, 2002, doi:10.1002/nme.341). A vertex moves only if the worst TetQuality around it
/// does not fall.
class MeanRatioSmoothing {
public:
  /// Vertices with a higher average mean ratio stay; a lattice has 0.95. Chosen, not measured.
  static constexpr double good_enough = 0.93;
  /// First trial step over the mean distance to the neighbours. Chosen, not measured.
  static constexpr double first_step = 0.15;
  /// Least gain of a move in the mean inverse ratio. Chosen, not measured.
  static constexpr double least_gain = 1e-3;

  /// Visits the free vertices in order, `passes` times. Returns the number of moves.
  std::int64_t run(TetMesh& mesh, int passes);

private:
  void score_vertices(const TetMesh& mesh);
  bool relax(TetMesh& mesh, LocalIndex v);
  /// Moves vertex v with the star _star, unless a quality falls below `least`.
  bool move(TetMesh& mesh, LocalIndex v, Vec3 to, double least);

  std::vector<float> _mean;  ///< average mean ratio around each vertex
  std::vector<LocalIndex> _star;
  std::vector<double> _after;  ///< qualities of _star after the move
  InverseRatios _ratios;
};

}  // namespace aeroloom::improve
