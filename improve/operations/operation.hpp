/// An operation: one way to improve a tetrahedron. And what all operations work on.
#pragma once

#include "cad/model/evaluation/point_locator.hpp"
#include "improve/improve_options.hpp"
#include "improve/limits/change_limits.hpp"
#include "improve/limits/local_target.hpp"
#include "improve/operations/bad_element_queue.hpp"
#include "improve/operations/over_constrained_count.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Changes that operations made.
struct OperationCounts {
  std::int64_t smoothed = 0;  ///< vertices moved inside
  std::int64_t slid = 0;      ///< vertices moved along CAD faces and curves
  std::int64_t replaced = 0;  ///< cavities
};

/// The mesh that operations change, the rules they keep to, and the queue that hears of each change.
class OperationContext {
public:
  /// All must outlive it. With a locator, vertices of the boundary may slide on its model.
  OperationContext(TetMesh& mesh, const LocalTarget& local_target, const ChangeLimits& limits, Effort effort,
                   cad::PointLocator* locator, BadElementQueue& queue)
      : _mesh(mesh),
        _local_target(local_target),
        _limits(limits),
        _effort(effort),
        _locator(locator),
        _queue(queue) {}

  TetMesh& mesh() const { return _mesh; }
  const ChangeLimits& limits() const { return _limits; }
  Effort effort() const { return _effort; }
  cad::PointLocator* locator() const { return _locator; }
  const BadElementQueue& queue() const { return _queue; }
  /// The quality below which a tetrahedron is worked on.
  double target_of(LocalIndex t) const { return _queue.target_of(t); }

  /// From now on no change may leave more tetrahedra with several faces on the boundary.
  void forbid_over_constrained() { _over_constrained.emplace(); }

  /// Makes a change that is allowed: each new tetrahedron is positive and better than the worst old one, and
  /// all limits hold. False: nothing has changed.
  bool apply(const CavityReplacement& change);
  /// As apply, where a vertex of the new tetrahedra moves.
  bool apply_moving(const CavityReplacement& change, LocalIndex v, Vec3 position);
  /// As apply, where the last vertex of the new tetrahedra is a new one in the region of `beside`.
  bool apply_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside);
  /// Whether apply_adding would make the change.
  bool allows_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside);
  /// A vertex has moved. `star`: its tetrahedra; `t`, which is worked on, waits for the next sweep.
  void note_moved(const std::vector<LocalIndex>& star, LocalIndex t) { _queue.note_moved(star, t); }

  OperationCounts counts;

private:
  bool allows(const CavityReplacement& change);

  TetMesh& _mesh;
  const LocalTarget& _local_target;
  const ChangeLimits& _limits;
  Effort _effort;
  cad::PointLocator* _locator;
  BadElementQueue& _queue;
  std::optional<OverConstrainedCount> _over_constrained;  ///< where their number must not rise
  std::vector<LocalIndex> _placed;
};

/// Improves one tetrahedron at a time, and keeps its memory from one to the next. All operations stand in
/// one array (operations.cpp).
class LocalOperation {
public:
  virtual ~LocalOperation() = default;
  /// Changes the mesh around a tetrahedron below its target so that the worst quality there rises. False:
  /// nothing has changed.
  virtual bool improve(OperationContext& context, LocalIndex t) = 0;
};

/// Vertices on which an operation failed: each rests until something around it has changed.
class RestingVertices {
public:
  bool contains(const BadElementQueue& queue, LocalIndex v) const {
    return static_cast<std::size_t>(v) < _failed.size() && _failed[v] != 0 &&
           !queue.has_changed_since(_failed[v], v);
  }
  void add(const OperationContext& context, LocalIndex v) {
    if (static_cast<std::size_t>(v) >= _failed.size()) _failed.resize(context.mesh().vertex_count(), 0);
    _failed[v] = context.queue().now();
  }

private:
  std::vector<std::uint32_t> _failed;  ///< per vertex: when; 0: never
};

}  // namespace aeroloom::improve
