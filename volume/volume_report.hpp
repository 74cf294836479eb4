/// The report of the volume stage.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// The report of the decomposition.
struct DecompositionReport {
  std::int64_t blocks = 0;  ///< of the lattice
  std::int64_t lattice_points = 0;
  std::int64_t shell_points = 0;     ///< those of them that zones are filled with
  std::int64_t core_tetrahedra = 0;  ///< that will come from a table, about
  double expected_tetrahedra = 0;    ///< from points and triangles, with the core's
  std::int32_t zones = 0;
  double imbalance = 1;  ///< heaviest zone over the mean, halo included

  static constexpr auto fields() {
    return std::tuple(&DecompositionReport::blocks, &DecompositionReport::lattice_points,
                      &DecompositionReport::shell_points, &DecompositionReport::core_tetrahedra,
                      &DecompositionReport::expected_tetrahedra, &DecompositionReport::zones,
                      &DecompositionReport::imbalance);
  }
};

/// A zone that could not be filled at first.
struct Retry {
  std::int32_t zone;
  std::string change;  ///< what was done about it
  std::string reason;

  static constexpr auto fields() { return std::tuple(&Retry::zone, &Retry::change, &Retry::reason); }
};

/// A place where zones made different tetrahedra, and which of them counts.
struct Disagreement {
  geometry::Vec3 place;
  std::int32_t zone;   ///< that counts
  std::int32_t faces;  ///< that did not match
  std::int32_t round;

  static constexpr auto fields() {
    return std::tuple(&Disagreement::place, &Disagreement::zone, &Disagreement::faces, &Disagreement::round);
  }
};

/// The report of the filling.
struct VolumeReport {
  std::int64_t tetrahedra = 0;
  std::int64_t core_tetrahedra = 0;  ///< those of them that come from a table, the others from TetGen
  std::int64_t left_core = 0;        ///< leaves that left the core since a triangle of its border was missing
  double overlap = 1;  ///< points of the shell that zones know, all together, over those there are
  std::int64_t steiner_points = 0;  ///< that TetGen had to add inside
  std::vector<Retry> retries;
  std::vector<Disagreement> disagreements;
  int rounds = 1;            ///< of filling; further ones fill again what failed or disagreed
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below

  static constexpr auto fields() {
    return std::tuple(&VolumeReport::tetrahedra, &VolumeReport::core_tetrahedra, &VolumeReport::left_core,
                      &VolumeReport::overlap, &VolumeReport::steiner_points, &VolumeReport::retries,
                      &VolumeReport::disagreements, &VolumeReport::rounds, &VolumeReport::load_error_90);
  }
};

}  // namespace aeroloom::volume
