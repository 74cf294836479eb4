/// Options of the improvement stage.
#pragma once

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// At most this fraction of the tetrahedra has a smaller dihedral angle.
struct PercentileTarget {
  double fraction, angle;  ///< of 1; degrees
};

struct ImproveOptions {
  bool enabled = true;
  double target_angle = 28;  ///< degrees; tetrahedra with a smaller dihedral angle, or a larger one than 180
                             ///< minus 1.5 times this, are worked on
  int sweeps = 12;           ///< at most; ends earlier when sweeps gain little
  int relaxation =
      1;  ///< passes of smoothing for the average (mean_ratio_smoothing.hpp, border_smoothing.hpp)
  bool boundary_may_change = true;   ///< its triangles may flip and edges contract within one CAD face
  int over_constrained_trials = 20;  ///< changes tried, at most, for a tetrahedron with several faces on the
                                     ///< boundary that goes only at the cost of angles around it
                                     ///< (over_constrained_trials.hpp)
  int shifted_rounds = 3;  ///< at most, across the borders of pieces; ends earlier when nothing is left
  /// Where one is missed afterwards, the stage works once more with its angle, at most 50 degrees, as the
  /// target, the least angle first.
  std::vector<PercentileTarget> percentiles = {};
};

/// The effort spent on tetrahedra beside strips that are narrower than their elements
/// (local_target.hpp).
enum class Effort : std::int8_t {
  reduced,  ///< operations that hardly ever gain there are left out, and the local target is lower
  full      ///< as much as elsewhere, and the worst alone decides: for few
};

}  // namespace aeroloom::improve
