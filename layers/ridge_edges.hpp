/// The edges along which fans have sectors.
#pragma once

#include "layers/local_wall.hpp"
#include "layers/vertex_stars.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// An edge of a ridge, in the local triangle on its left.
struct RidgeEdge {
  std::int32_t triangle;
  std::array<std::int32_t, 2> ends;   ///< counter-clockwise in the triangle
  std::array<std::int32_t, 2> slots;  ///< by end: its place among Ridge::edges there; -1: none
  bool is_owned;                      ///< no lower triangle has it
};

/// The edges of ridges on walls, once for all numbers of sectors that are tried.
struct RidgeEdges {
  std::vector<RidgeEdge> edges;  ///< by triangle
  /// By vertex: of the ridge's edges there, as smooth along it as mean edges are over the wall; off ridges
  /// mean edges.
  std::vector<double> lengths;
};

/// `mean_edges`: smooth_mean_edges(). Collective.
RidgeEdges list_ridge_edges(const LocalWall& wall, const VertexStars& stars,
                            const std::vector<double>& mean_edges);

}  // namespace aeroloom::layers
