/// Options of the volume stage.
#pragma once

#include <cstdint>
#include <optional>

namespace aeroloom::volume {

struct VolumeOptions {
  /// Wanted size of a zone, and so of a piece of the mesh, tetrahedra; empty: what suits their number.
  std::optional<std::int64_t> piece_tets = {};
  /// Distance lattice points keep from the surface, in local sizes: the value with the fewest bad tetrahedra
  /// of seven (benchmarks/results/volume_pieces.md).
  double lattice_clearance = 0.5;
  /// Of lattice points, in mean edges of the lattice: enough for general position, and so little that all
  /// triangles between core and shell are in the mesh of the shell (as above).
  double perturbation = 0.005;
  double halo = 1.2;  ///< width of what a zone knows around it, in the largest sizes there
  std::int64_t largest_zone = 20'000'000;  ///< predicted tetrahedra above which a zone is refused
  double base_cpu_seconds = 10;            ///< of the child of a zone; its size adds to them
  int retries = 3;                         ///< after the first try, before zones are merged
};

}  // namespace aeroloom::volume
