/// How many sectors the fans along ridges have.
#pragma once

#include "layers/ridge_edges.hpp"
#include "layers/vertex_fans.hpp"
#include "layers/wanted_layers.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::layers {

struct Sectors {
  std::map<std::int32_t, VertexFan> fans;  ///< by vertex
  std::vector<std::int32_t> is_end;        ///< by vertex: 1 where a fan ends on a wall

  const VertexFan* fan_at(std::int32_t vertex) const {
    const auto found = fans.find(vertex);
    return found == fans.end() ? nullptr : &found->second;
  }
};

/// What numbers of sectors follow from, by vertex if nothing else is said.
struct FanNeeds {
  const std::vector<VertexLayers>& wanted;
  const std::vector<FittedLayers>& fitted;  ///< fit_wanted_layers()
  const RidgeEdges& ridges;                 ///< list_ridge_edges()
  const std::vector<double>& edges;         ///< smooth_mean_edges()
  /// The height that limits leave to columns much lower than wanted, else infinite; 0: no fan.
  const std::vector<double>& reached;
  /// By edge of a triangle that a fan's face lies beside, three a triangle: how often the number is to be
  /// halved.
  const std::vector<std::int32_t>& halvings;
};

/// Edges of a ridge have all as many sectors, as the turn asks for where it is largest, at most 35 degrees
/// each, and as the front: over columns of the wanted heights a sector is at most two and a half edges wide,
/// and where the whole ridge is low, over those that are reached, at least 0.3 edges. Never is a sector wider
/// than 75 degrees. Where a ridge ends on a wall, or its columns cannot see each other, sectors end at a
/// vertex that is to have no layers: with layers there the first one would need cells with faces along the
/// wall. Ridges with no vertex two edges away from such ends have no sectors. Collective.
Sectors count_sectors(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs);

/// The sectors that a turn, in radians, asks for, and the front over columns of this height. `edge`: length
/// of the ridge's edges there.
std::int32_t wanted_sectors(double turn, double height, double edge);

}  // namespace aeroloom::layers
