/// Removal of over-constrained tetrahedra, which have two or more faces on the boundary. All their vertices
/// are then on the boundary, where a solver knows the values. So they add nothing to its equations, or a
/// determinant of zero. They are swapped or split if the angles allow it.
#pragma once

#include "improve/limits/change_limits.hpp"
#include "improve/operations/over_constrained_count.hpp"
#include "improve/operations/ring_filling.hpp"
#include "improve/operations/smoothing.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::improve {

/// A change that leaves fewer of them. If `place` is set, the new tetrahedra share a new vertex there with
/// the number mesh.vertex_count().
struct OverConstrainedChange {
  CavityReplacement cavity;
  std::optional<Vec3> place;
};

/// Treats each such tetrahedron, in the order of slots. Possible changes are a 2-3 swap of a face, the
/// removal or the splitting of the interior edge, and a new vertex inside the tetrahedron and its neighbours.
/// A change must leave fewer over-constrained tetrahedra. No new tetrahedron may be worse than the worst old
/// one, unless it reaches a fraction of the target. Size limits hold; mean ratios may fall, since angles are
/// bounded here. The boundary stays.
class OverConstrainedRemoval {
public:
  /// `fraction` of the target; below 1 if the result is improved afterwards.
  explicit OverConstrainedRemoval(const ChangeLimits& limits, double fraction = 1)
      : _limits(limits), _fraction(fraction) {}

  /// Makes the best change for each, preferably without a new vertex. Returns the number of replaced
  /// cavities.
  std::int64_t run(TetMesh& mesh);
  /// All possible changes for one tetrahedron, best first.
  const std::vector<OverConstrainedChange>& find(TetMesh& mesh, LocalIndex t);
  /// Returns the slots of the new tetrahedra.
  const std::vector<LocalIndex>& apply(TetMesh& mesh, const OverConstrainedChange& change);

private:
  bool remove(TetMesh& mesh, LocalIndex t);
  void find_swaps(const TetMesh& mesh, LocalIndex t);
  void find_new_vertices(TetMesh& mesh, LocalIndex t);
  void swap_face(const TetMesh& mesh, LocalIndex t, int face);
  void remove_edge(const TetMesh& mesh, LocalIndex t, int edge);
  void split_edge(TetMesh& mesh, LocalIndex t, int edge);
  /// Considers a new vertex that sees all faces of this cavity.
  void fill_around_vertex(TetMesh& mesh, const std::vector<LocalIndex>& cavity);
  void split_neighbourhood(TetMesh& mesh, LocalIndex t);
  /// Considers new vertices in the stars of one or two vertices of t.
  void fill_stars(TetMesh& mesh, LocalIndex t);
  void sort_found();
  void consider(const TetMesh& mesh);
  void consider_vertex(TetMesh& mesh, Vec3 place);
  bool is_good(const TetMesh& mesh, const CavityReplacement& cavity);
  /// The least quality of new tetrahedra.
  double bar_of(const TetMesh& mesh, double before) const;

  const ChangeLimits& _limits;
  double _fraction;
  EdgeRing _edge_ring;
  RingFilling _filling;
  ConeOptimiser _cones;
  std::vector<OverConstrainedChange> _found;
  CavityReplacement _trial;
  OverConstrainedCount _count;
  std::vector<LocalIndex> _placed, _cavity;
};

}  // namespace aeroloom::improve
