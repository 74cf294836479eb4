/// Replacement of a cavity around a bad tetrahedron by cones from one point: a free vertex or a new one.
#pragma once

#include "improve/operations/smoothing.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::improve {

/// Grows a cavity across its worst face, keeps the best state on the way, and optimises the point (a greedy
/// form of the vertex insertion of Klingner and Shewchuk, 16th International Meshing Roundtable, 2007,
/// doi:10.1007/978-3-540-75103-8_1).
class CavityInsertion {
public:
  static constexpr int most_tets = 80;  ///< largest cavity; docs/bounds.md

  /// Proposes a cavity grown from the star of a free vertex, which moves. The mesh does not change yet.
  bool propose_around_vertex(TetMesh& mesh, LocalIndex vertex, CavityReplacement& cavity);
  /// Proposes a cavity grown from tetrahedron t around a new vertex with the number mesh.vertex_count().
  /// `start` chooses the first position of the vertex: t's centre or near a corner, edge or face. Different
  /// starts give different cavities.
  bool propose_new_vertex(TetMesh& mesh, LocalIndex t, int start, CavityReplacement& cavity);
  static constexpr int starts = 15;  // the centre, 4 corners, 6 edges, 4 faces
  /// The position of the free point in the last proposal.
  Vec3 position() const { return _point; }

private:
  /// A face of the cavity, counter-clockwise seen from inside; `side` belongs to the cavity.
  struct Wall {
    std::array<LocalIndex, 3> corners;
    HalfFace side;
    double quality;  ///< of the cone on it
  };
  bool propose(TetMesh& mesh, LocalIndex apex, CavityReplacement& cavity);
  /// Starts with a tetrahedron on the boundary and its neighbours. False if it is not on the boundary.
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
