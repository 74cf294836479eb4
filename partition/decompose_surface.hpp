/// From a background surface to the pieces of a surface mesh.
#pragma once

#include "partition/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

struct SurfaceDecompositionOptions {
  double piece_load = 50'000;  ///< wanted load of a piece, in the unit of the triangles' loads
  /// Degrees that borders of pieces make with each other and with feature curves at least, where the surface
  /// allows it. 0: plain METIS on the dual graph, to compare with.
  double smallest_angle = 40;
};

struct SurfaceDecomposition {
  std::vector<std::int32_t> part;  ///< per triangle, numbered by first triangle
  std::int32_t parts = 1;
};

/// Contracts the dual graph, partitions it by METIS and repairs the result: parts are connected, and angles
/// above the threshold or listed by cut_wedges(). A function of its arguments alone.
SurfaceDecomposition decompose_surface(const BackgroundSurface& surface,
                                       const SurfaceDecompositionOptions& options);

}  // namespace aeroloom::partition
