/// What the patches around a vertex ask of its column.
#pragma once

#include "layers/local_wall.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::layers {

/// Of a vertex with several patches each value is the smallest.
struct VertexLayers {
  double first = 0, growth = 0, total = 0;  ///< total: infinite where none is asked for
  double edge_sum = 0;  ///< lengths of the edges of layered triangles, each from both its sides
  std::int64_t edges = 0, count = 0, constant = 0;  ///< count: most_layers where none is asked for

  static constexpr auto fields() {
    return std::tuple(&VertexLayers::first, &VertexLayers::growth, &VertexLayers::total,
                      &VertexLayers::edge_sum, &VertexLayers::edges, &VertexLayers::count,
                      &VertexLayers::constant);
  }
  double mean_edge() const { return edges > 0 ? edge_sum / static_cast<double>(edges) : 0; }
};

/// By vertex, equal in all pieces. Vertices without layered triangles have no edges. Collective.
std::vector<VertexLayers> gather_wanted_layers(const LocalWall& wall, const LayerOptions& options);

}  // namespace aeroloom::layers
