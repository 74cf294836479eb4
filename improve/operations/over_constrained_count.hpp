/// Counting over-constrained tetrahedra: those with several faces on the boundary.
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// How many faces of a tetrahedron are on the boundary.
int count_boundary_faces(const TetMesh& mesh, LocalIndex t);

/// How changes that leave the boundary as it is alter the number of over-constrained tetrahedra.
class OverConstrainedCount {
public:
  /// How many more a change leaves than there are.
  int added_by(const TetMesh& mesh, const CavityReplacement& cavity);

private:
  std::vector<std::array<LocalIndex, 3>> _sides;  ///< on the boundary, of what goes
};

}  // namespace aeroloom::improve
