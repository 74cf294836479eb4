/// The tetrahedra below their targets, in the order in which they are worked on.
#pragma once

#include "improve/limits/local_target.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Holds tetrahedra, worst first, ties on the slot. One sweep gives each once, and what changes leave behind
/// with it. A tetrahedron that was tried in vain comes again when something around it has changed, or at a
/// higher level. The level of a sweep grows with the operations in use (operations.hpp).
class BadElementQueue {
public:
  /// `last_level_in_narrow_regions`: no operation is added there at a higher level.
  BadElementQueue(const TetMesh& mesh, const LocalTarget& local_target, int last_level_in_narrow_regions);

  /// Begins a sweep with all tetrahedra below their targets. Returns their number.
  std::int64_t fill();
  /// The worst one that is worth trying at this level; nothing when none is left.
  std::optional<LocalIndex> pop(int level);
  /// The operations of this level failed on a tetrahedron.
  void note_failure(LocalIndex t, int level);
  /// These tetrahedra are new.
  void note_new(const std::vector<LocalIndex>& tets);
  /// These tetrahedra have another shape; `deferred` waits for the next sweep.
  void note_moved(const std::vector<LocalIndex>& tets, LocalIndex deferred);
  /// Treats all but the new ones as tried in vain at this level.
  void rest_all_but(const std::vector<LocalIndex>& fresh, int level);

  double target_of(LocalIndex t) const { return _local_target(_mesh.corners(t)); }
  /// Whether operations that cost most are kept from it: they hardly ever gain beside a strip.
  bool skips_costly(LocalIndex t) const {
    return _local_target.is_limited(_mesh.corners(t)) && !_local_target.is_severe(_mesh.quality(t));
  }
  /// Counts changes of the mesh.
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
    std::uint32_t version = 0;      ///< tasks of older versions are stale
    std::uint32_t attempt = 0;      ///< when it was last tried in vain; 0: never
    std::int8_t attempt_level = 0;  ///< of that attempt
  };
  static constexpr std::uint32_t start = 1;

  bool is_worth_trying(LocalIndex t, int level) const;
  void push(LocalIndex t);

  const TetMesh& _mesh;
  const LocalTarget& _local_target;
  int _last_level_in_narrow_regions;
  std::vector<Task> _heap;  ///< worst on top
  std::vector<SlotHistory> _slots;
  std::vector<std::uint32_t> _changed;  ///< per vertex: when something around it changed last
  std::uint32_t _now = start;
};

}  // namespace aeroloom::improve
