/// Removal of one or several faces between two vertices: an edge between the vertices takes their place (the
/// 2-3 swap and its generalisation, the inverse of edge removal).
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// Grows the set of faces that both vertices see over neighbouring faces as long as the worst tetrahedron
/// gains (Shewchuk, Two discrete optimization algorithms for the topological improvement of tetrahedral
/// meshes, 2002).
class FaceRemoval {
public:
  static constexpr int growth_depth = 2;  ///< faces between the first one and the outermost

  /// Proposes the removal of face i of tetrahedron t and of what neighbours should go with it. False when
  /// nothing beats both the cavity as it is and `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, int face, double floor, CavityReplacement& cavity);

private:
  /// A face between the two vertices: its tetrahedra on both sides.
  struct FaceTets {
    LocalIndex below, above;
  };
  double grow(const TetMesh& mesh, const FaceTets& from, LocalIndex u, LocalIndex v, int depth);
  bool find_neighbour(const TetMesh& mesh, const FaceTets& from, LocalIndex u, LocalIndex v, FaceTets& next,
                      LocalIndex& apex) const;

  LocalIndex _below = 0, _above = 0;  ///< the two vertices
  std::vector<FaceTets> _faces;
  std::vector<std::array<LocalIndex, 2>> _ring;
};

}  // namespace aeroloom::improve
