/// The report of the volume stage.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// The report of the decomposition.
struct DecompositionReport {
  std::int64_t blocks = 0;  ///< of the lattice
  std::int64_t lattice_points = 0;
  std::int64_t shell_points = 0;     ///< lattice points that zones are filled with
  std::int64_t core_tetrahedra = 0;  ///< from a table, approximate
  double expected_tetrahedra = 0;    ///< from points and triangles, core included
  std::int32_t zones = 0;
  double imbalance = 1;  ///< load of the heaviest zone over the mean load, halos included
};

/// A retry of a zone.
struct Retry {
  std::int32_t zone;
  std::string change;  ///< the remedy
  std::string reason;  ///< why the zone was not filled
};

/// A place where zones made different tetrahedra.
struct Disagreement {
  geometry::Vec3 place;
  std::int32_t zone;   ///< whose tetrahedra are kept
  std::int32_t faces;  ///< number of faces without partner
  std::int32_t round;
};

/// The report of the filling.
struct VolumeReport {
  std::int64_t tetrahedra = 0;
  std::int64_t core_tetrahedra = 0;  ///< from a table; all others are from TetGen
  std::int64_t left_core = 0;        ///< core leaves that became shell, because a border triangle was missing
  double overlap = 1;  ///< lattice points of all zones, halos included, over the points of the shell
  std::int64_t steiner_points = 0;  ///< points that TetGen had to add
  std::vector<Retry> retries;
  std::vector<Disagreement> disagreements;
  int rounds = 1;            ///< of filling; after the first, only zones that failed or disagree
  double load_error_90 = 0;  ///< 90 % of the expected loads have a smaller relative error
};

}  // namespace aeroloom::volume
