/// Options of the volume stage.
#pragma once

#include <cstdint>
#include <optional>

namespace aeroloom::volume {

struct VolumeOptions {
  /// Wanted tetrahedra of a zone, and so of a piece of the mesh. Empty: by the tetrahedra of the mesh.
  std::optional<std::int64_t> piece_tets = {};
  /// The least distance of lattice points from the surface, in local sizes. Of seven values this one gave the
  /// fewest bad tetrahedra (benchmarks/results/volume_pieces.md).
  double lattice_clearance = 0.5;
  /// The width of the perturbation of lattice points, in mean edges of the lattice. Large enough for general
  /// position, and so small that no triangle between core (template) and shell (TetGen) is missing
  /// (volume_pieces.md).
  double perturbation = 0.005;
  double halo = 1.2;                       ///< width of the halo of a zone, in the largest sizes there
  std::int64_t largest_zone = 20'000'000;  ///< predicted tetrahedra; a larger zone is refused
  double base_cpu_seconds = 10;            ///< of the process that fills a zone; more by its size
  int retries = 3;                         ///< of a zone, before it is merged with another
};

}  // namespace aeroloom::volume
