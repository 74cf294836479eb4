/// Tetrahedra with two or more faces on the boundary: all their vertices are on it, where a solver knows the
/// values, so they add nothing to its equations (or a determinant of zero). Where the angles allow they are
/// swapped or split.
#pragma once

#include "improve/change_limits.hpp"
#include "improve/ring_filling.hpp"
#include "improve/smoothing.hpp"
#include "improve/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// For each such tetrahedron, by slot: a face between it and a neighbour gives way to an edge (2-3 swap), or
/// the edge that is on neither triangle goes (edge removal), or gets a vertex, or the tetrahedron and its
/// neighbours give way to those of a vertex between them. What leaves fewer of them, the best worst quality
/// first, is done where no new tetrahedron is below a share of the target, or below the worst of those that
/// go. Edges keep to sizes; the mean ratio may fall, which angles bound here. The boundary stays as it is.
class CornerRelief {
public:
  /// `share`: of the target; below one where what gets worse is improved afterwards.
  explicit CornerRelief(const ChangeLimits& limits, double share = 1) : _limits(limits), _share(share) {}

  /// Returns how many cavities were filled anew.
  std::int64_t run(TetMesh& mesh);

private:
  bool relieve(TetMesh& mesh, LocalIndex t);
  void swap_face(const TetMesh& mesh, LocalIndex t, int face);
  void remove_edge(const TetMesh& mesh, LocalIndex t, int edge);
  bool split_edge(TetMesh& mesh, LocalIndex t, int edge);
  /// The cavity of these tetrahedra gets a vertex inside, that sees all its faces.
  bool fill_around_vertex(TetMesh& mesh, const std::vector<LocalIndex>& cavity);
  bool split_neighbourhood(TetMesh& mesh, LocalIndex t);
  /// Keeps the trial where it is better than what was found so far.
  void consider(const TetMesh& mesh);
  bool is_good(const TetMesh& mesh, const Replacement& cavity);
  /// What new tetrahedra must reach.
  double bar_of(const TetMesh& mesh, double before) const;
  /// Of those with several faces on the boundary; leaves the faces in _sides.
  int count_before(const TetMesh& mesh, const Replacement& cavity);
  int count_after(const Replacement& cavity) const;

  const ChangeLimits& _limits;
  double _share;
  EdgeRing _edge_ring;
  RingFilling _filling;
  ConeOptimiser _cones;
  Replacement _best, _trial;
  std::vector<std::array<LocalIndex, 3>> _sides;  ///< on the boundary, of what goes
  std::vector<LocalIndex> _placed, _cavity;
};

/// How many faces of a tetrahedron are on the boundary.
int count_boundary_faces(const TetMesh& mesh, LocalIndex t);

}  // namespace aeroloom::improve
