/// The shape measures of many tetrahedra at a time.
#pragma once

#include "mesh/data/piece.hpp"

namespace aeroloom::mesh {

/// Of consecutive tetrahedra of a piece, bit for bit what the functions of quality.hpp give.
class TetMeasures {
public:
  static constexpr int most = 64;

  /// Of `count` tetrahedra from `first` on, `most` at most.
  void measure(const Piece& piece, LocalIndex first, int count);

  double volume6[most];                                    ///< six times the volume
  double smallest_dihedral[most], largest_dihedral[most];  ///< degrees
  double mean_ratio[most], radius_ratio[most];

private:
  void gather(const Piece& piece, LocalIndex first, int count);
  void measure_edges_and_normals();

  double _points[4][3][most] = {};       // of corner, axis, tetrahedron
  double _lowest[most], _highest[most];  // see dihedral_range
  double _squared_edges[most];
};

}  // namespace aeroloom::mesh
