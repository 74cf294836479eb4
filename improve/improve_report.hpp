/// The report of the improvement stage.
#pragma once

#include <cstdint>
#include <tuple>

namespace aeroloom::improve {

struct ImproveReport {
  std::int64_t bad_before = 0, bad_after = 0;        ///< tetrahedra that miss the target
  double min_angle_before = 0, min_angle_after = 0;  ///< degrees
  std::int64_t smoothed = 0;                         ///< vertices inside moved
  std::int64_t slid = 0;                             ///< vertices moved along CAD faces and curves
  std::int64_t replaced = 0;                         ///< cavities filled anew
  std::int64_t changed_triangles = 0;                ///< of the boundary

  bool is_lattice = false;  ///< of one piece, left as it is

  static constexpr auto fields() {
    return std::tuple(&ImproveReport::bad_before, &ImproveReport::bad_after, &ImproveReport::min_angle_before,
                      &ImproveReport::min_angle_after, &ImproveReport::smoothed, &ImproveReport::slid,
                      &ImproveReport::replaced, &ImproveReport::changed_triangles,
                      &ImproveReport::is_lattice);
  }
  /// Adds the changes of another run.
  void add_changes(const ImproveReport& of) {
    smoothed += of.smoothed;
    slid += of.slid;
    replaced += of.replaced;
    changed_triangles += of.changed_triangles;
  }
};

}  // namespace aeroloom::improve
