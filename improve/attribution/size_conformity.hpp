/// Comparison of edge lengths with the size field.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::attribution {

struct SizeConformity {
  /// Fraction of edges with 0.7 to 1.4 times the size at their midpoint. An edge counts once in each piece.
  /// In pieces with more than 200 vertices about 200 vertices are sampled.
  double good_edges = 0;
  double fair_edges = 0;      ///< the same with 0.5 to 2 times the size
  double mean_edge = 0;       ///< over the local size
  double bytes_per_cell = 0;  ///< memory of the pieces
};

/// Collective. For reports only: the last bits of sums depend on the ranks.
SizeConformity measure_conformity(const mesh::DistributedMesh& mesh, const sizing::SizeField& field);

}  // namespace aeroloom::attribution
