/// How many sectors the fans along ridges have.
#pragma once

#include "layers/vertex_fans.hpp"
#include "layers/vertex_stars.hpp"
#include "layers/wanted_layers.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::layers {

/// An edge with sectors, in the local triangle on its left.
struct RidgeEdge {
  std::int32_t triangle;
  std::array<std::int32_t, 2> ends;   ///< counter-clockwise in the triangle
  std::array<std::int32_t, 2> slots;  ///< by end: its place among Ridge::edges there; -1: none
  bool is_owned;                      ///< no lower triangle has it
  bool is_rim;                        ///< the free rim of a baffle
};

struct Sectors {
  std::vector<RidgeEdge> edges;            ///< by triangle
  std::map<std::int32_t, VertexFan> fans;  ///< by vertex

  const VertexFan* fan_at(std::int32_t vertex) const {
    const auto found = fans.find(vertex);
    return found == fans.end() ? nullptr : &found->second;
  }
};

/// What numbers of sectors follow from, by vertex.
struct FanNeeds {
  const std::vector<VertexLayers>& wanted;
  const std::vector<double>& edges;  ///< smooth_mean_edges()
  /// The height that limits leave to columns much lower than wanted, else infinite.
  const std::vector<double>& reached;
  const std::vector<std::int32_t>& halvings;  ///< how often the number is to be halved
};

/// Edges of a ridge have all as many sectors, as the turn asks for where it is largest, at most 35 degrees
/// each, and as the front: over columns of the wanted heights a sector is at most two and a half edges wide,
/// and where the whole ridge is low, over those that are reached, at least 0.3 edges. Never is a sector wider
/// than 75 degrees. Paths have as many as the ridges that they join. Ridges must close, end on planes, or go
/// on along paths: a sector cannot end on a wall, as the first layer would need cells with faces along
/// it. Where one ridge does not, none has sectors; where the free rim of a baffle does not, it has none.
/// Collective.
Sectors count_sectors(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs);

/// The height of a column that is as high as wanted.
double wanted_height(const VertexLayers& asked, double edge);

}  // namespace aeroloom::layers
