/// A wall with what is known of its vertices before columns grow.
#pragma once

#include "layers/column_limits.hpp"
#include "layers/directions.hpp"
#include "layers/vertex_stars.hpp"
#include "tests/meshes/wall_meshes.hpp"

#include <cstddef>
#include <vector>

namespace aeroloom::layers::examples {

/// Layers of the same first height on each patch.
inline LayerOptions layers_on(std::size_t patches) {
  LayerOptions options;
  options.patches.resize(patches);
  for (WallLayers& wanted : options.patches) wanted.first = 1e-3;
  return options;
}

/// A wall with its stars and directions, one column on each vertex. Refers to the mesh.
struct DirectedWall {
  DirectedWall(const mesh::DistributedMesh& mesh, const LayerOptions& options)
      : wall(mesh, options),
        stars(gather_stars(wall)),
        fans(without_fans(wall)),
        directions(find_directions(wall, stars, fans)) {}

  LocalWall wall;
  VertexStars stars;
  Fans fans;
  Directions directions;
};

/// The columns that patches ask for. Refers to the wall.
inline ColumnLimits limits_of(const DirectedWall& base, const LayerOptions& options) {
  const std::vector<VertexLayers> wanted = gather_wanted_layers(base.wall, options);
  const std::vector<FittedLayers> fitted = fit_wanted_layers(wanted, smooth_mean_edges(base.wall, wanted));
  return {base.wall, wanted, fitted, base.stars, base.directions};
}

/// A cube of edge 1 in a box.
inline Shapes cube_in_a_box() {
  return Shapes()
      .add_box({-4, -4, -4}, {5, 5, 5}, {3, 3, 3}, Fluid::inside)
      .add_box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, Fluid::outside);
}

}  // namespace aeroloom::layers::examples
