/// How well a mesh keeps to the sizes asked for.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::attribution {

struct SizeConformity {
  /// Part of the edges with 0.7 to 1.4 times the size at their middles; an edge counts once in each piece. Of
  /// pieces with more than 200 vertices those of some 200 are looked at.
  double good_edges = 0;
  double fair_edges = 0;      ///< the same with 0.5 to 2 times the size
  double mean_edge = 0;       ///< in local sizes
  double bytes_per_cell = 0;  ///< of memory the pieces occupy
};

/// Collective. A report: sums depend on how pieces are spread over ranks in the last bits.
SizeConformity measure_conformity(const mesh::DistributedMesh& mesh, const sizing::SizeField& field);

}  // namespace aeroloom::attribution
