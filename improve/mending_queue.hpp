/// Which bad tetrahedron is worked on when, and with what.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/limits/attainable_quality.hpp"
#include "improve/operations/boundary_flip.hpp"
#include "improve/operations/cavity_insertion.hpp"
#include "improve/operations/corner_count.hpp"
#include "improve/operations/edge_contraction.hpp"
#include "improve/operations/edge_removal.hpp"
#include "improve/operations/face_removal.hpp"
#include "improve/operations/sliding.hpp"
#include "improve/operations/small_polyhedron.hpp"
#include "improve/operations/smoothing.hpp"
#include "improve/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Works through the tetrahedra below the target, worst first, ties on the slot. One sweep tries each once,
/// and what swaps leave behind with it; a tetrahedron that resisted is tried again when something around it
/// has changed, or when stronger means are allowed.
class MendingQueue {
public:
  /// With a locator, vertices of the boundary slide on its model.
  MendingQueue(TetMesh& mesh, const AttainableQuality& attainable, const ChangeLimits& limits,
               Effort effort = Effort::sparing, cad::PointLocator* locator = nullptr);

  /// For a mesh that was improved already, but for these tetrahedra, which relieved a corner: others rest
  /// until something around them changes, and no change brings more tetrahedra with several faces on the
  /// boundary.
  void follow_relief(const std::vector<LocalIndex>& fresh);
  /// At most `sweeps` sweeps; ends earlier when one gains hardly anything.
  void run(int sweeps);
  std::int64_t smoothed() const { return _smoothed; }
  std::int64_t slid() const { return _slid; }
  std::int64_t replaced() const { return _replaced; }

private:
  /// Means, each including the ones before.
  enum class Means : std::int8_t { swaps_and_smoothing, moving_cavities, new_vertices };
  struct Task {
    double quality;
    LocalIndex tet;
    std::uint32_t version;
  };

  struct Sweep {
    std::int64_t tasks, gains;
  };
  /// Times count changes of the mesh; 0: never.
  struct SlotHistory {
    std::uint32_t version = 0;  ///< tasks of older versions are stale
    std::uint32_t attempt = 0;  ///< when it was last tried in vain, and with which means
    Means attempt_means = Means::swaps_and_smoothing;
  };
  struct VertexHistory {
    std::uint32_t changed = 1;  ///< when something around it changed last
    std::uint32_t smoothed_in_vain = 0, slid_in_vain = 0, moved_in_vain = 0;
  };
  Sweep sweep(Means means);
  void fill_heap();
  void push(LocalIndex t);
  bool mend(LocalIndex t, Means means);
  bool swap(LocalIndex t);
  bool smooth(LocalIndex t);
  bool slide(LocalIndex t);
  bool contract(LocalIndex t);
  bool move_cavity(LocalIndex t);
  bool insert_vertex(LocalIndex t);
  /// Whether `_trial` may be done, whose new vertex stands there.
  bool is_allowed_with_vertex(Vec3 position, LocalIndex beside);
  bool reconnect(LocalIndex t);
  bool is_allowed(const Replacement& cavity);
  bool apply(const Replacement& cavity);
  /// Tetrahedra are new or have moved; `deferred` waits for the next sweep.
  void note_change(const std::vector<LocalIndex>& tets, LocalIndex deferred);
  double target_of(LocalIndex t) const { return _attainable(_mesh.corners(t)); }
  /// Whether the means that cost most are kept from it: they hardly ever gain beside a strip.
  bool is_spared(LocalIndex t) const {
    return _attainable.is_limited(_mesh.corners(t)) && !_attainable.is_severe(_mesh.quality(t));
  }
  bool worth_trying(LocalIndex t, Means means) const;
  /// Whether the star of a vertex is another one than at that time.
  bool has_changed_since(std::uint32_t time, LocalIndex v) const {
    return time == 0 || _vertices[v].changed > time;
  }

  TetMesh& _mesh;
  const AttainableQuality& _attainable;
  const ChangeLimits& _limits;
  const Effort _effort;
  EdgeRemoval _edge_removal;
  BoundaryFlip _boundary_flip;
  FaceRemoval _face_removal;
  Smoothing _smoothing;
  std::optional<Sliding> _sliding;
  std::optional<CornerCount> _corners;  ///< where their number must not rise
  EdgeContraction _contraction;
  CavityInsertion _insertion;
  SmallPolyhedron _polyhedron;
  Replacement _best, _trial;
  std::vector<LocalIndex> _placed, _star;
  std::vector<Task> _heap;  ///< worst on top
  std::vector<SlotHistory> _slots;
  std::vector<VertexHistory> _vertices;
  std::uint32_t _now = 1;
  std::int64_t _smoothed = 0, _slid = 0, _replaced = 0;
};

}  // namespace aeroloom::improve
