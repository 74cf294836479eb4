/// Smoothing for the average: vertices whose tetrahedra are worse shaped than those of a lattice move to
/// where the sum of their inverse mean ratios is smaller, which counts the worst most.
#pragma once

#include "improve/operations/inverse_ratios.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// One step of steepest descent of the sum of inverse mean ratios per vertex and pass, with a line search
/// (Freitag and Knupp, Int. J. Numer. Meth. Engng 53, 2002, doi:10.1002/nme.341). A vertex moves only
/// when the worst TetQuality around it does not fall.
class MeanRatioSmoothing {
public:
  /// Mean ratio on average around a vertex that stays where it is; a lattice has 0.95. Chosen, not measured.
  static constexpr double good_enough = 0.93;
  /// The first step that is tried, of the mean distance to the neighbours. Chosen, not measured.
  static constexpr double first_step = 0.15;
  /// The least gain of a move, of the mean of the inverse ratios. Chosen, not measured.
  static constexpr double least_gain = 1e-3;

  /// Visits the free vertices in their order, `passes` times. Returns how many moves were made.
  std::int64_t run(TetMesh& mesh, int passes);

private:
  void score_vertices(const TetMesh& mesh);
  bool relax(TetMesh& mesh, LocalIndex v);
  /// Moves the vertex of _star unless a quality falls below `least`.
  bool move(TetMesh& mesh, LocalIndex v, Vec3 to, double least);

  std::vector<float> _mean;  ///< mean ratio around each vertex
  std::vector<LocalIndex> _star;
  std::vector<double> _after;  ///< qualities of _star where it moves to
  InverseRatios _ratios;
};

}  // namespace aeroloom::improve
