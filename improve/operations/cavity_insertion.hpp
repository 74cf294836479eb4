/// Filling a cavity around a bad tetrahedron anew from one point: an existing free vertex, or a new one.
#pragma once

#include "improve/operations/smoothing.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// Grows a cavity by the neighbour over its worst face as long as the cones from the point gain, and places
/// the point best (a greedy form of the vertex insertion of Klingner and Shewchuk, 16th International Meshing
/// Roundtable, 2007, doi:10.1007/978-3-540-75103-8_1).
class CavityInsertion {
public:
  static constexpr int most_tets = 80;  ///< of a cavity; docs/bounds.md

  /// Proposes a cavity grown from all tetrahedra around a free vertex, which moves. Nothing in the mesh
  /// changes yet.
  bool propose_around_vertex(TetMesh& mesh, LocalIndex vertex, CavityReplacement& cavity);
  /// Proposes a cavity grown from tetrahedron t around a new vertex, whose number in the cavity is
  /// mesh.vertex_count(). Growth begins at t's centre, or nearer to one of its corners, edges or faces: other
  /// starts end in other cavities.
  bool propose_new_vertex(TetMesh& mesh, LocalIndex t, int start, CavityReplacement& cavity);
  static constexpr int starts = 15;  // the centre, 4 corners, 6 edges, 4 faces
  /// Where the free point of the last proposal goes.
  Vec3 position() const { return _point; }

private:
  /// A face of the cavity, counter-clockwise seen from inside it; `side` belongs to the cavity.
  struct Wall {
    std::array<LocalIndex, 3> corners;
    HalfFace side;
    double quality;  ///< of the cone to it
  };
  bool propose(TetMesh& mesh, LocalIndex apex, CavityReplacement& cavity);
  /// Begins with a tetrahedron on the boundary and its neighbours; false where it is not on the boundary.
  bool start_at_neighbour(const TetMesh& mesh, LocalIndex t);
  void collect_walls(const TetMesh& mesh);
  void grow(const TetMesh& mesh);
  void add_walls(const TetMesh& mesh, LocalIndex t);
  void absorb(const TetMesh& mesh, LocalIndex t);
  bool keeps_fixed_vertices(const TetMesh& mesh) const;
  bool contains(LocalIndex t) const;

  std::vector<LocalIndex> _tets;
  std::vector<Wall> _walls;
  ConeOptimiser _cones;
  Vec3 _point;
};

}  // namespace aeroloom::improve
