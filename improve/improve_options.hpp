/// Options of the improvement stage.
#pragma once

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// A limit on small angles: at most `fraction` of the tetrahedra may have a dihedral angle below `angle`.
struct PercentileTarget {
  double fraction, angle;  ///< between 0 and 1; degrees
};

struct ImproveOptions {
  bool enabled = true;
  double target_angle = 28;  ///< degrees; a tetrahedron is bad if it has a dihedral angle below this or above
                             ///< 180 - 1.5 times this
  int sweeps = 12;           ///< at most; fewer if sweeps gain little
  int relaxation =
      1;  ///< passes of smoothing for average quality (mean_ratio_smoothing.hpp, border_smoothing.hpp)
  bool boundary_may_change = true;   ///< boundary edges may flip and contract within one CAD face
  int over_constrained_trials = 20;  ///< most trials for an over-constrained tetrahedron that no single
                                     ///< operation removes (pieces/over_constrained_trials.hpp)
  int shifted_rounds = 3;  ///< most rounds across the borders of pieces; fewer if no bad tetrahedra are left
  /// If the mesh misses one of these afterwards, the stage runs again with its angle as target, but at most
  /// 50 degrees. The smallest angle comes first.
  std::vector<PercentileTarget> percentiles = {};
};

/// Effort for tetrahedra in narrow regions of the surface (limits/local_target.hpp).
enum class Effort : std::int8_t {
  reduced,  ///< skips operations that hardly ever succeed there, and lowers the local target
  full      ///< as elsewhere; only the worst quality counts; for few tetrahedra
};

}  // namespace aeroloom::improve
