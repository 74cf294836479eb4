/// The report of the improvement stage.
#pragma once

#include <algorithm>
#include <cstdint>

namespace aeroloom::improve {

/// Number of bad tetrahedra, which miss the target, and the smallest dihedral angle.
struct BadState {
  std::int64_t bad = 0;
  double least_angle = 180;  ///< degrees
};

struct ImproveReport {
  std::int64_t bad_before = 0, bad_after = 0;        ///< bad tetrahedra
  double min_angle_before = 0, min_angle_after = 0;  ///< degrees
  std::int64_t smoothed = 0;                         ///< interior vertices moved
  std::int64_t slid = 0;                             ///< vertices moved along CAD faces and curves
  std::int64_t replaced = 0;                         ///< cavities replaced
  std::int64_t changed_triangles = 0;                ///< boundary triangles

  bool is_lattice = false;  ///< of one piece: it needed no work
  /// Sets the state before any change. Until note_after() it is also the state after.
  void note_before(const BadState& state) {
    bad_before = state.bad;
    min_angle_before = state.least_angle;
    note_after(state);
  }
  void note_after(const BadState& state) {
    bad_after = state.bad;
    min_angle_after = state.least_angle;
  }
  /// Adds the report of other tetrahedra.
  void add(const ImproveReport& of) {
    bad_before += of.bad_before;
    bad_after += of.bad_after;
    min_angle_before = std::min(min_angle_before, of.min_angle_before);
    min_angle_after = std::min(min_angle_after, of.min_angle_after);
    add_changes(of);
  }
  /// Adds the changes of another run on the same tetrahedra.
  void add_changes(const ImproveReport& of) {
    smoothed += of.smoothed;
    slid += of.slid;
    replaced += of.replaced;
    changed_triangles += of.changed_triangles;
  }
};

}  // namespace aeroloom::improve
