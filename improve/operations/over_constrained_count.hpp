/// Counts of over-constrained tetrahedra: those with several faces on the boundary.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// The number of faces of a tetrahedron on the boundary.
int count_boundary_faces(const TetMesh& mesh, LocalIndex t);

/// Counts over-constrained tetrahedra before and after a change that keeps the boundary.
class OverConstrainedCount {
public:
  /// How many a change adds; negative if it removes some.
  int added_by(const TetMesh& mesh, const CavityReplacement& cavity);

private:
  std::vector<std::array<LocalIndex, 3>> _sides;  ///< boundary faces of the old tetrahedra
};

}  // namespace aeroloom::improve
