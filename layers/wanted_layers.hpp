/// The layers that the patches around a vertex request for its column.
#pragma once

#include "layers/column_heights.hpp"
#include "layers/local_wall.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// Of several patches at a vertex the smallest value of each kind counts.
struct VertexLayers {
  double first = 0, growth = 0, total = 0;  ///< total: infinite if not limited
  double edge_sum = 0;  ///< edge lengths of triangles with layers; each edge counts from both sides
  std::int64_t edges = 0, count = 0, constant = 0;  ///< count: most_layers if not limited
  double mean_edge() const { return edges > 0 ? edge_sum / static_cast<double>(edges) : 0; }
  /// As a patch asks for them.
  WallLayers as_of_patch() const;
};

/// By vertex, equal in all pieces. Vertices without layered triangles have no edges. Collective.
std::vector<VertexLayers> gather_wanted_layers(const LocalWall& wall, const LayerOptions& options);

/// Mean edges at the vertices, smoothed over the wall. Columns are several edges high, so what edges differ
/// by from vertex to vertex would be several times as much at their ends. Collective.
std::vector<double> smooth_mean_edges(const LocalWall& wall, const std::vector<VertexLayers>& wanted);

/// By vertex: wanted_layers() for its mean edge; none where no layers are wanted.
std::vector<FittedLayers> fit_wanted_layers(const std::vector<VertexLayers>& wanted,
                                            const std::vector<double>& edges);

/// The height of a column that is as high as wanted.
double wanted_height(const VertexLayers& wanted, const FittedLayers& fitted);

/// The lengths of a triangle's sides, from its corners 0, 1 and 2 to the next.
std::array<double, 3> sides_of(const LocalWall& wall, std::int32_t triangle);
/// Whether the longest side is more than two and a half times the shortest; chosen, not measured.
bool is_stretched(const std::array<double, 3>& sides);

/// First heights are measured along the normals of triangles. Leaning columns are longer, by this ratio, at
/// most two. `slant`: Directions::slants.
inline double lengthening_of(double slant) {
  return std::min(2.0, 1 / slant);
}

}  // namespace aeroloom::layers
