/// Removal of over-constrained tetrahedra, those with two or more faces on the boundary: all their vertices
/// are on it, where a solver knows the values, so they add nothing to its equations (or a determinant of
/// zero). Where the angles allow they are swapped or split.
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

/// A change that leaves fewer of them. With a place, the new tetrahedra share a vertex there, whose number is
/// the mesh's vertex count.
struct OverConstrainedChange {
  CavityReplacement cavity;
  std::optional<Vec3> place;
};

/// For each such tetrahedron, by slot: a face between it and a neighbour gives way to an edge (2-3 swap), or
/// the edge that is on neither triangle goes (edge removal), or gets a vertex, or the tetrahedron and its
/// neighbours give way to those of a vertex between them. What leaves fewer of them is done where no new
/// tetrahedron is below a fraction of the target, or below the worst of those that go. Edges keep to sizes;
/// the mean ratio may fall, which angles bound here. The boundary stays as it is.
class OverConstrainedRemoval {
public:
  /// `fraction`: of the target; below one where what gets worse is improved afterwards.
  explicit OverConstrainedRemoval(const ChangeLimits& limits, double fraction = 1)
      : _limits(limits), _fraction(fraction) {}

  /// Does the best for each, without a new vertex where that is possible. Returns how many cavities were
  /// filled anew.
  std::int64_t run(TetMesh& mesh);
  /// All there are for one, the best worst quality first.
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
  /// The cavity of these tetrahedra gets a vertex inside, that sees all its faces.
  void fill_around_vertex(TetMesh& mesh, const std::vector<LocalIndex>& cavity);
  void split_neighbourhood(TetMesh& mesh, LocalIndex t);
  /// The cavities of tetrahedra around one or two of the vertices get a vertex inside.
  void fill_stars(TetMesh& mesh, LocalIndex t);
  void sort_found();
  void consider(const TetMesh& mesh);
  void consider_vertex(TetMesh& mesh, Vec3 place);
  bool is_good(const TetMesh& mesh, const CavityReplacement& cavity);
  /// The quality that new tetrahedra must have.
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
