/// The queue of bad tetrahedra: those below their targets, in the order of treatment.
#pragma once

#include "improve/limits/local_target.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Gives the worst tetrahedron first, ties by slot. A sweep gives each one once, and those that changes leave
/// bad. After a failure a tetrahedron comes again when something around it changed, or at a higher level. The
/// level of a sweep grows with the operations in use (operations.hpp).
class BadElementQueue {
public:
  /// `last_level_in_narrow_regions`: the highest level at which an operation is added there.
  BadElementQueue(const TetMesh& mesh, const LocalTarget& local_target, int last_level_in_narrow_regions);

  /// Starts a sweep with all tetrahedra below their targets. Returns their number.
  std::int64_t fill();
  /// The worst tetrahedron worth trying at this level, or nothing if none is left.
  std::optional<LocalIndex> pop(int level);
  /// Records that all operations of this level failed on a tetrahedron.
  void note_failure(LocalIndex t, int level);
  /// Records new tetrahedra.
  void note_new(const std::vector<LocalIndex>& tets);
  /// Records tetrahedra that changed shape; `deferred` waits for the next sweep.
  void note_moved(const std::vector<LocalIndex>& tets, LocalIndex deferred);
  /// Marks all tetrahedra but the new ones as failed at this level.
  void rest_all_but(const std::vector<LocalIndex>& fresh, int level);

  double target_of(LocalIndex t) const { return _local_target(_mesh.corners(t)); }
  /// Whether costly operations are skipped, because they hardly ever succeed in narrow regions.
  bool skips_costly(LocalIndex t) const {
    return _local_target.is_limited(_mesh.corners(t)) && !_local_target.is_severe(_mesh.quality(t));
  }
  /// The number of changes so far, as a clock.
  std::uint32_t now() const { return _now; }
  /// Whether something around a vertex has changed since then.
  bool has_changed_since(std::uint32_t time, LocalIndex v) const { return _changed[v] > time; }

private:
  struct Task {
    double quality;
    LocalIndex tet;
    std::uint32_t version;
  };
  struct SlotHistory {
    std::uint32_t version = 0;      ///< tasks of older versions are outdated
    std::uint32_t attempt = 0;      ///< time of the last failure; 0: never
    std::int8_t attempt_level = 0;  ///< level of that failure
  };
  static constexpr std::uint32_t start = 1;

  bool is_worth_trying(LocalIndex t, int level) const;
  void push(LocalIndex t);

  const TetMesh& _mesh;
  const LocalTarget& _local_target;
  int _last_level_in_narrow_regions;
  std::vector<Task> _heap;  ///< a heap, worst on top
  std::vector<SlotHistory> _slots;
  std::vector<std::uint32_t> _changed;  ///< per vertex: time of the last change around it
  std::uint32_t _now = start;
};

}  // namespace aeroloom::improve
