/// The interface of an operation, which improves a tetrahedron in one way, and the context it works in.
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

/// Counts of changes made by operations.
struct OperationCounts {
  std::int64_t smoothed = 0;  ///< interior vertices moved
  std::int64_t slid = 0;      ///< vertices moved along CAD faces and curves
  std::int64_t replaced = 0;  ///< cavities replaced
};

/// The mesh that operations change, the limits on changes, and the queue that records each change.
class OperationContext {
public:
  /// All arguments must outlive the object. With a locator, boundary vertices may slide on its CAD model.
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

  /// From now on, rejects changes that add over-constrained tetrahedra (over_constrained_count.hpp).
  void forbid_over_constrained() { _over_constrained.emplace(); }

  /// Makes a change if each new tetrahedron is positive and better than the worst old one, and all limits
  /// hold. Otherwise returns false, and nothing has changed.
  bool apply(const CavityReplacement& change);
  /// The same for a change that moves vertex v.
  bool apply_moving(const CavityReplacement& change, LocalIndex v, Vec3 position);
  /// The same for a change that adds a vertex. It has the highest number and lies in the region of `beside`.
  bool apply_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside);
  /// Whether apply_adding would make the change.
  bool allows_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside);
  /// Records that a vertex with this star moved. Tetrahedron t waits for the next sweep.
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
  std::optional<OverConstrainedCount> _over_constrained;  ///< if their number must not rise
  std::vector<LocalIndex> _placed;
};

/// An operation that improves one tetrahedron at a time and keeps its working memory. All are listed in
/// operations.cpp.
class LocalOperation {
public:
  virtual ~LocalOperation() = default;
  /// Changes the mesh around a tetrahedron below its target so that the worst quality there rises. False if
  /// nothing has changed.
  virtual bool improve(OperationContext& context, LocalIndex t) = 0;
};

/// Vertices on which an operation failed. Each is skipped until something around it changes.
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
  std::vector<std::uint32_t> _failed;  ///< per vertex: time of failure; 0: none
};

}  // namespace aeroloom::improve
