/// Removal of faces between two vertices: an edge between the vertices replaces them (the 2-3 swap and its
/// generalisation, the inverse of edge removal).
#pragma once

#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// Collects faces that both vertices see. Adds neighbouring faces as long as the worst tetrahedron improves
/// (Shewchuk, Two discrete optimization algorithms for the topological improvement of tetrahedral meshes,
/// 2002).
class FaceRemoval {
public:
  static constexpr int growth_depth = 2;  ///< faces between the first and the outermost one

  /// Proposes to remove face i of tetrahedron t, and neighbouring faces with it. False if nothing beats both
  /// the cavity and `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, int face, double floor, CavityReplacement& cavity);

private:
  /// The tetrahedra on both sides of a face.
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
